// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Axis-aligned box [m]. Each member or argument of this type states the coordinate frame.
struct VIEWGAIN_EXPORT Box {
  std::array<double, 3> min{};  ///< lowest corner [m]
  std::array<double, 3> max{};  ///< highest corner [m]

  /// Whether the box contains the point (x, y, z) [m]. False for NaN; never throws. Points on the
  /// lower faces are inside and points on the upper faces are outside, so adjacent boxes share no
  /// point. Exception: in a ReachRegion, points on all faces are inside.
  [[nodiscard]] bool contains(double x, double y, double z) const {
    return x >= min[0] && x < max[0] && y >= min[1] && y < max[1] && z >= min[2] && z < max[2];
  }
  bool operator==(const Box&) const = default;
};

}  // namespace viewgain
