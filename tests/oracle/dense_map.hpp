// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::oracle {

/// A belief grid as one array of states, [x][y][z] with z fastest.
struct DenseMap {
  double voxel_size = 0;  ///< [m]
  Pose T_world_grid;
  Index3 min_index;
  Index3 dims;
  std::vector<std::uint8_t> states;

  explicit DenseMap(const BeliefGrid& grid);

  [[nodiscard]] bool inside(Index3 voxel) const;
  /// Position of a voxel of the workspace in `states`.
  [[nodiscard]] std::size_t position(Index3 voxel) const;
  /// Outside the workspace nothing is known to block: free.
  [[nodiscard]] VoxelState state(Index3 voxel) const;
};

}  // namespace viewgain::oracle
