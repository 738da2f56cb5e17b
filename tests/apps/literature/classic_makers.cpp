// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/literature/classic_makers.hpp"

#include "grid/voxels.hpp"

namespace viewgain::test {

std::vector<ClassicGain> all_classic_gains() {
  std::vector<ClassicGain> gains;
  for (std::size_t i = 0; i < classic_gain_names().size(); ++i) {
    gains.push_back(static_cast<ClassicGain>(i));
  }
  return gains;
}

void vary_log_odds(BeliefGrid& grid, Random& random) {
  const VoxelBox all = VoxelBox::from_dims(grid.min_index(), grid.dims());
  std::vector<BeliefGrid::VoxelValue> values;
  const Index3 first{all.min.x & ~7, all.min.y & ~7, all.min.z & ~7};
  const auto vary = [&](Index3 leaf) {
    const bool is_uniform = uniform_int(random, 0, 1) == 0;
    double free = 0.1 * uniform_int(random, -20, 0);
    const VoxelBox block = all.intersection(VoxelBox::from_dims(leaf, {8, 8, 8}));
    for_each_voxel(block, [&](Index3 voxel) {
      const VoxelState state = grid.state(voxel);
      if (state == VoxelState::unknown) return;
      if (!is_uniform) free = uniform(random, -2, 0);
      const double value = state == VoxelState::free ? free : uniform(random, 0.05, 3.5);
      values.push_back({voxel, static_cast<float>(value)});
    });
  };
  for_each_voxel(VoxelBox{first, all.max}, vary, 8);
  grid.set(values);
}

}  // namespace viewgain::test
