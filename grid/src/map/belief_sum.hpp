// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "viewgain/grid/belief.hpp"

namespace viewgain::detail {

/// A belief that grows, in double precision; rounded() is what the map keeps of it.
class BeliefSum {
 public:
  /// `way`: from this sum's centre to the belief's own [m].
  void add(const Belief& belief, const Eigen::Vector3d& way);
  /// A reading `offset` [m] from the centre.
  void add(const SymmetricMatrix3& information, const Eigen::Vector3d& offset);

  /// Each number is rounded up or down by chance, the nearer more often, so that the errors of
  /// many sums grow with the root of their count, not with the count: to the nearest, readings from
  /// one side would always be rounded the same way, and that hides a weak axis. The chance is a
  /// hash of the number's bits and the count of readings, hence the same everywhere. A number that
  /// single precision holds stays as it is; one beyond its largest is that. The information is made
  /// definite().
  [[nodiscard]] Belief rounded() const;

 private:
  std::array<double, 6> information_{};
  Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
  double hits_ = 0;
};

/// The belief with an information that is positive definite, where rounding has made it another: 2t
/// of its diagonal is added to it, t the smallest power of two, 2^-24 or more, with t of which it
/// is. As it is where it is positive definite, or a zero or the largest number on its diagonal
/// lets nothing help.
[[nodiscard]] Belief definite(const Belief& belief);

}  // namespace viewgain::detail
