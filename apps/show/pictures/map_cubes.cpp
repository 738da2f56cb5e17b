// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/map_cubes.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace viewgain::app {

namespace {

// Leaf by leaf.
std::vector<Index3> occupied_voxels(const GridSnapshot& snapshot) {
  std::vector<Index3> voxels;
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    for (unsigned offset = 0; offset < 512; ++offset) {
      if (!test_bit(leaf.occupied, offset)) continue;
      voxels.push_back({leaf.origin.x + static_cast<std::int32_t>(offset >> 6U),
                        leaf.origin.y + static_cast<std::int32_t>(offset >> 3U & 7U),
                        leaf.origin.z + static_cast<std::int32_t>(offset & 7U)});
    }
  }
  return voxels;
}

}  // namespace

LatticeCubes occupied_cubes(const GridSnapshot& snapshot, std::size_t most) {
  LatticeCubes cubes{occupied_voxels(snapshot), snapshot.voxel_size};
  const auto sort_and_merge = [&] {
    std::sort(cubes.at.begin(), cubes.at.end(), [](const Index3& a, const Index3& b) {
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    cubes.at.erase(std::unique(cubes.at.begin(), cubes.at.end()), cubes.at.end());
  };
  sort_and_merge();
  for (; cubes.at.size() > most; cubes.side *= 2) {
    for (Index3& at : cubes.at) at = {at.x >> 1, at.y >> 1, at.z >> 1};
    sort_and_merge();
  }
  return cubes;
}

}  // namespace viewgain::app
