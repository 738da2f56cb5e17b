// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ranges>
#include <vector>

#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::detail {

/// w_v of a voxel: that of the last region that holds its centre, 1 outside all.
[[nodiscard]] inline double task_weight(const std::vector<GainConfig::WeightRegion>& regions,
                                        Index3 voxel, double voxel_size) {
  const Eigen::Vector3d center = voxel_center(voxel, voxel_size);
  for (const GainConfig::WeightRegion& region : std::views::reverse(regions)) {
    if (region.box.contains(center.x(), center.y(), center.z())) return region.weight;
  }
  return 1.0;
}

}  // namespace viewgain::detail
