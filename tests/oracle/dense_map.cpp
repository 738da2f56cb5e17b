// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oracle/dense_map.hpp"

namespace viewgain::oracle {

DenseMap::DenseMap(const BeliefGrid& grid)
    : voxel_size(grid.voxel_size()),
      T_world_grid(grid.T_world_grid()),
      min_index(grid.min_index()),
      dims(grid.dims()),
      states(grid.voxel_count()) {
  grid.copy_states(states);
}

bool DenseMap::inside(Index3 voxel) const {
  return voxel.x >= min_index.x && voxel.x < min_index.x + dims.x && voxel.y >= min_index.y &&
         voxel.y < min_index.y + dims.y && voxel.z >= min_index.z && voxel.z < min_index.z + dims.z;
}

std::size_t DenseMap::position(Index3 voxel) const {
  const auto x = static_cast<std::size_t>(voxel.x - min_index.x);
  const auto y = static_cast<std::size_t>(voxel.y - min_index.y);
  const auto z = static_cast<std::size_t>(voxel.z - min_index.z);
  return (x * static_cast<std::size_t>(dims.y) + y) * static_cast<std::size_t>(dims.z) + z;
}

VoxelState DenseMap::state(Index3 voxel) const {
  return inside(voxel) ? static_cast<VoxelState>(states[position(voxel)]) : VoxelState::free;
}

}  // namespace viewgain::oracle
