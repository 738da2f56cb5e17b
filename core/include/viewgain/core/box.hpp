// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Axis-aligned box [m]. The member or argument that holds the box states its frame, and whether
/// points on its faces count as inside.
struct VIEWGAIN_EXPORT Box {
  std::array<double, 3> min{};  ///< lowest corner [m]
  std::array<double, 3> max{};  ///< highest corner, excluded [m]

  /// Whether the box contains the point (x, y, z) [m]; false for NaN, never throws. The interval is
  /// half-open, [min, max), so adjacent boxes share no point. A ReachRegion includes the faces of
  /// its boxes.
  [[nodiscard]] bool contains(double x, double y, double z) const {
    return x >= min[0] && x < max[0] && y >= min[1] && y < max[1] && z >= min[2] && z < max[2];
  }
  bool operator==(const Box&) const = default;
};

}  // namespace viewgain
