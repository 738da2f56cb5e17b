// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "viewgain/grid/belief.hpp"

namespace viewgain::detail {

/// A growing belief in double precision; rounded() gives the stored belief.
class BeliefSum {
 public:
  /// `way`: from this sum's centre to the belief's [m].
  void add(const Belief& belief, const Eigen::Vector3d& way);
  /// Adds a reading at `offset` [m] from the centre.
  void add(const SymmetricMatrix3& information, const Eigen::Vector3d& offset);

  /// Rounds each number up or down at random, with a probability given by the distance, so that
  /// errors grow with the square root of the number of sums. Rounding to nearest would always round
  /// readings from one side in the same way and hide a weak axis. The randomness is a hash of the
  /// number's bits and the count, so it is the same on all machines. Numbers that single precision
  /// holds do not change; larger ones are clamped. The information is made definite().
  [[nodiscard]] Belief rounded() const;

 private:
  std::array<double, 6> information_{};
  Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
  double hits_ = 0;
};

/// The belief with positive definite information. If rounding broke that, adds 2t of its diagonal,
/// where t is the smallest power of two, at least 2^-24, that makes it positive definite. Unchanged
/// if it is positive definite, or if a zero or the largest number on its diagonal prevents it.
[[nodiscard]] Belief definite(const Belief& belief);

}  // namespace viewgain::detail
