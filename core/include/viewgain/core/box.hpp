// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Axis-aligned box [m], in the frame that its use names, and whether its faces belong to it.
struct VIEWGAIN_EXPORT Box {
  std::array<double, 3> min{};  ///< lowest corner [m]
  std::array<double, 3> max{};  ///< highest corner, which is not part of it [m]

  /// Whether the point (x, y, z) [m] is in it; never throws, false for NaN. Half-open, [min, max),
  /// so that boxes side by side share no point. A ReachRegion, where a camera may stand on the
  /// limit, takes its boxes as closed.
  [[nodiscard]] bool contains(double x, double y, double z) const {
    return x >= min[0] && x < max[0] && y >= min[1] && y < max[1] && z >= min[2] && z < max[2];
  }
  bool operator==(const Box&) const = default;
};

}  // namespace viewgain
