// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "viewgain/core/box.hpp"

namespace viewgain::detail {

/// A box with any orientation against axis-aligned boxes and triangles, by separating axes: exact
/// but for rounding. Overlaps of less than `touch` along an axis count as touching, not as
/// overlapping. All lengths in one unit, whatever it is.
class OrientedBox {
 public:
  /// Columns of R: the box's axes, orthonormal; `half`: half its size along them.
  OrientedBox(const Eigen::Vector3d& center, const Eigen::Matrix3d& R, const Eigen::Vector3d& half,
              double touch);

  /// The axis-aligned box round it.
  [[nodiscard]] Box bounds() const;

  /// Distances between centres from which on a box of this half size is separated, one an axis. For
  /// testing many boxes of one size.
  using Limits = std::array<double, 15>;
  [[nodiscard]] Limits limits(const Eigen::Vector3d& half_other) const;

  /// Against an axis-aligned box of the size that the limits are for.
  [[nodiscard]] bool overlaps(const Eigen::Vector3d& center_other, const Limits& limits) const {
    const Eigen::Vector3d offset = center_other - center_;
    for (std::size_t i = 0; i < axis_count_; ++i) {
      if (std::abs(axes_[i].dot(offset)) >= limits[i]) return false;
    }
    return true;
  }
  [[nodiscard]] bool overlaps(const Box& box) const;

  /// Against a triangle, which may have no area.
  [[nodiscard]] bool overlaps(const std::array<Eigen::Vector3d, 3>& corners) const;

 private:
  Eigen::Vector3d center_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d half_;
  double touch_;
  /// Unit vectors: the box's three axes, the three of the frame, and the cross products of the two
  /// that are long enough to have a direction.
  std::array<Eigen::Vector3d, 15> axes_;
  std::array<double, 15> extent_{};  ///< half the box's length along each
  std::size_t axis_count_ = 0;
};

}  // namespace viewgain::detail
