// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "belief_blocks.hpp"
#include "code_mask.hpp"
#include "grid_layout.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"

namespace viewgain {
namespace {

using namespace detail;

BeliefGrid::Statistics statistics_of(const BeliefGrid& grid, const VoxelBox& range,
                                     Criterion criterion) {
  const auto prior = SymmetricMatrix3::identity(1.0 / (grid.prior_sigma() * grid.prior_sigma()));
  const BlockLattice lattice(grid.min_index(), grid.dims());
  BeliefGrid::Statistics result;
  for (const auto& [key, block] : beliefs_of(grid)) {
    std::size_t rank = 0;
    const LeafMask part = block_mask(range, lattice.origin(key));
    for_each_bit(block->mask, [&, &beliefs = block->beliefs](unsigned offset) {
      const std::uint32_t hits = beliefs[rank++].hits;
      if (test_bit(part, offset)) result.hits += hits;
    });
  }
  const auto part_of = [&](Index3 origin, std::int32_t size) {
    return range.intersection(VoxelBox::from_dims(origin, {size, size, size}));
  };
  visit_grid(
      grid,
      [&](Index3 origin, const std::uint8_t* codes) {
        const LeafMask inside = block_mask(range, origin);
        const LeafMask occupied = intersection(inside, occupied_mask(codes));
        const std::uint64_t occupied_count = count_bits(occupied);
        result.occupied += occupied_count;
        result.free += count_bits(intersection(inside, known_mask(codes))) - occupied_count;
        if (occupied_count == 0) return;
        const BeliefBlock* block = find_beliefs(grid, part_of(origin, kBlockSize).min);
        if (block == nullptr) return;
        const double share = surface_share(block->scale);
        for_each_bit(intersection(occupied, block->mask), [&](unsigned offset) {
          const SymmetricMatrix3 information = block->find(offset)->information_matrix() * share;
          result.entropy_removed += entropy_reduction(prior, information, criterion) / share;
        });
      },
      [&](Index3 origin, std::int32_t size, std::uint8_t code) {
        if (code != kUnknownCode) result.free += part_of(origin, size).volume();
      });
  result.unknown = range.volume() - result.free - result.occupied;
  result.bytes = bytes_of(grid);
  return result;
}

}  // namespace

BeliefGrid::Statistics BeliefGrid::statistics(Criterion criterion) const {
  return statistics_of(*this, VoxelBox::from_dims(min_index(), dims()), criterion);
}

BeliefGrid::Statistics BeliefGrid::statistics(const Box& region, Criterion criterion) const {
  return statistics_of(*this, voxels_in(*this, region), criterion);
}

double BeliefGrid::mean_sigma(const Box& region) const {
  const VoxelBox range = voxels_in(*this, region);
  const double floor = voxel_size() * voxel_size() / 12.0;
  double sum = 0, believed = 0;
  for_each_occupied([&](const VoxelValue& at) {
    if (!at.belief || !range.contains(at.voxel)) return;
    const double voxels = 1 / surface_share(scale(at.voxel));
    sum += voxels *
           std::sqrt(at.belief->information_matrix().inverse().trace() / 3.0 + floor * voxels);
    believed += voxels;
  });
  return believed > 0 ? sum / believed : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace viewgain
