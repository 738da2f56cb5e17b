// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/region_statistics.hpp"

#include <cmath>
#include <limits>

#include "viewgain/support/block_lattice.hpp"
#include "voxels_in.hpp"

namespace viewgain {
RegionStatistics region_statistics(const BeliefGrid& grid, const Box& region, Criterion criterion) {
  using namespace detail;
  const VoxelBox range = voxels_in(grid, region);
  const SymmetricMatrix3 prior =
      SymmetricMatrix3::identity(1.0 / (grid.prior_sigma() * grid.prior_sigma()));
  const double floor = grid.voxel_size() * grid.voxel_size() / 12.0;

  RegionStatistics result;
  for (const BeliefBlockAt& block : grid.belief_blocks()) {
    const BeliefBlock& beliefs = *block.beliefs;
    for_each_bit(intersection(beliefs.mask, block_mask(range, block.origin)),
                 [&](unsigned offset) { result.hits += beliefs.find(offset)->hits; });
  }
  double sum_of_sigmas = 0;
  std::uint64_t believed = 0;
  const GridSnapshot snapshot = grid.snapshot();
  for (const VoxelBox& tile : snapshot.tiles) {
    result.unknown += range.intersection(tile).volume();
  }
  for (const SnapshotLeaf& leaf : snapshot.leaves) {
    const LeafMask part = block_mask(range, leaf.origin);
    const LeafMask occupied = intersection(part, leaf.occupied);
    const std::uint64_t occupied_count = count_bits(occupied);
    result.occupied += occupied_count;
    result.unknown += count_bits(intersection(part, leaf.non_free)) - occupied_count;
    if (leaf.beliefs == nullptr) continue;
    for_each_bit(intersection(occupied, leaf.beliefs->mask), [&](unsigned offset) {
      const SymmetricMatrix3 information = leaf.beliefs->find(offset)->information_matrix();
      result.entropy_removed += entropy_reduction(prior, information, criterion);
      sum_of_sigmas += std::sqrt(information.inverse().trace() / 3.0 + floor);
      ++believed;
    });
  }
  result.free = range.volume() - result.unknown - result.occupied;
  result.mean_sigma = believed > 0 ? sum_of_sigmas / static_cast<double>(believed)
                                   : std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace viewgain
