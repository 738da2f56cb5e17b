// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "code_mask.hpp"
#include "viewgain/support/grid_blocks.hpp"

namespace viewgain {

using namespace detail;

GridStatistics BeliefGrid::statistics(Criterion criterion) const {
  GridStatistics result;
  const BlockLattice lattice(min_index(), dims());
  const auto prior = SymmetricMatrix3::identity(1.0 / (prior_sigma() * prior_sigma()));
  visit_grid(
      *this,
      [&](Index3 origin, const std::uint8_t* codes) {
        LeafMask inside;
        inside.fill(~std::uint64_t{0});
        if (!lattice.covers(origin, kBlockSize)) inside = lattice.clip(origin);
        const LeafMask occupied = intersection(inside, occupied_mask(codes));
        const std::uint64_t occupied_count = count_bits(occupied);
        result.occupied += occupied_count;
        result.free += count_bits(intersection(inside, known_mask(codes))) - occupied_count;
        if (occupied_count == 0) return;
        const BeliefBlock* block = find_beliefs(*this, clipped(lattice, origin, kBlockSize).min);
        if (block == nullptr) return;
        for_each_bit(intersection(occupied, block->mask), [&](unsigned offset) {
          result.entropy_removed +=
              entropy_reduction(prior, block->find(offset)->information_matrix(), criterion);
        });
      },
      [&](Index3 origin, std::int32_t size, std::uint8_t code) {
        if (code != kUnknownCode) result.free += clipped(lattice, origin, size).volume();
      });
  result.unknown = voxel_count() - result.free - result.occupied;
  result.bytes = bytes_of(*this);
  return result;
}

}  // namespace viewgain
