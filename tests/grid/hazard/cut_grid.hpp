// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::test {

inline constexpr double kVoxel = 0.01;  // [m]

/// An unknown map whose workspace cuts blocks and hazard cells.
inline BeliefGrid cut_grid(Index3 dims) {
  GridConfig config;
  config.voxel_size = kVoxel;
  config.workspace = {{-0.13, 0.07, -1.0},
                      {-0.13 + dims.x * kVoxel, 0.07 + dims.y * kVoxel, -1.0 + dims.z * kVoxel}};
  config.prior_sigma = 0.01;
  return BeliefGrid(config);
}

}  // namespace viewgain::test
