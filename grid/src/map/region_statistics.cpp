// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/region_statistics.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "block_lattice.hpp"

namespace viewgain {
namespace {

using detail::intersection;
using Corner = std::array<std::int64_t, 3>;

Corner corner(const Index3& index) { return {index.x, index.y, index.z}; }

/// A box of voxels, [min, max).
struct VoxelRange {
  Corner min;
  Corner max;

  [[nodiscard]] VoxelRange common(const Corner& other_min, const Corner& other_max) const {
    VoxelRange range;
    for (std::size_t k = 0; k < 3; ++k) {
      range.min[k] = std::max(min[k], other_min[k]);
      range.max[k] = std::max(range.min[k], std::min(max[k], other_max[k]));
    }
    return range;
  }

  [[nodiscard]] std::uint64_t count() const {
    std::uint64_t product = 1;
    for (std::size_t k = 0; k < 3; ++k) product *= static_cast<std::uint64_t>(max[k] - min[k]);
    return product;
  }
};

// The voxels of the workspace whose centres lie in the region.
VoxelRange voxels_in(const BeliefGrid& grid, const Box& region) {
  const Corner lowest = corner(grid.min_index()), dims = corner(grid.dims());
  VoxelRange range;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto low = static_cast<double>(lowest[k]);
    const auto high = static_cast<double>(lowest[k] + dims[k]);
    // The first index i with (i + 1/2) V >= x, kept within what an integer can hold.
    const auto first = [&](double x) {
      return static_cast<std::int64_t>(
          std::clamp(std::ceil(x / grid.voxel_size() - 0.5), low, high));
    };
    range.min[k] = first(region.min[k]);
    range.max[k] = std::max(range.min[k], first(region.max[k]));
  }
  return range;
}

// The part of a leaf that lies in the range.
LeafMask mask_of(const VoxelRange& range, const Index3& origin) {
  const Corner base = corner(origin);
  const VoxelRange part = range.common(base, {base[0] + 8, base[1] + 8, base[2] + 8});
  LeafMask mask{};
  for (std::int64_t x = part.min[0]; x < part.max[0]; ++x) {
    for (std::int64_t y = part.min[1]; y < part.max[1]; ++y) {
      for (std::int64_t z = part.min[2]; z < part.max[2]; ++z) {
        mask[static_cast<std::size_t>(x - base[0])] |= std::uint64_t{1}
                                                       << ((y - base[1]) << 3 | (z - base[2]));
      }
    }
  }
  return mask;
}

// Calls visit(belief) for the beliefs of a block at the voxels of the mask, in order.
template <typename Visit>
void visit_beliefs(const BeliefBlock& block, const LeafMask& mask, const Visit& visit) {
  for (unsigned word = 0; word < 8; ++word) {
    for (std::uint64_t bits = mask[word] & block.mask[word]; bits != 0; bits &= bits - 1) {
      visit(block.beliefs[block.rank(word << 6U | static_cast<unsigned>(std::countr_zero(bits)))]);
    }
  }
}

std::uint64_t count(const LeafMask& mask) {
  std::uint64_t bits = 0;
  for (const std::uint64_t word : mask) bits += static_cast<std::uint64_t>(std::popcount(word));
  return bits;
}

}  // namespace

RegionStatistics region_statistics(const BeliefGrid& grid, const Box& region, Criterion criterion) {
  const VoxelRange range = voxels_in(grid, region);
  const SymmetricMatrix3 prior =
      SymmetricMatrix3::identity(1.0 / (grid.prior_sigma() * grid.prior_sigma()));
  const double floor = grid.voxel_size() * grid.voxel_size() / 12.0;

  RegionStatistics result;
  for (const BeliefBlockAt& block : grid.belief_blocks()) {
    visit_beliefs(*block.beliefs, mask_of(range, block.origin),
                  [&](const Belief& belief) { result.hits += belief.hits; });
  }
  double sum_of_sigmas = 0;
  std::uint64_t believed = 0;
  const GridSnapshot snapshot = grid.snapshot();
  for (const SnapshotTile& tile : snapshot.tiles) {
    result.unknown += range.common(corner(tile.min), corner(tile.max)).count();
  }
  for (const SnapshotLeaf& leaf : snapshot.leaves) {
    const LeafMask part = mask_of(range, leaf.origin);
    const LeafMask occupied = intersection(part, leaf.occupied);
    const std::uint64_t occupied_count = count(occupied);
    result.occupied += occupied_count;
    result.unknown += count(intersection(part, leaf.non_free)) - occupied_count;
    if (leaf.beliefs == nullptr) continue;
    visit_beliefs(*leaf.beliefs, occupied, [&](const Belief& belief) {
      const SymmetricMatrix3 information = belief.information_matrix();
      result.entropy_removed += entropy_reduction(prior, information, criterion);
      sum_of_sigmas += std::sqrt(information.inverse().trace() / 3.0 + floor);
      ++believed;
    });
  }
  result.free = range.count() - result.unknown - result.occupied;
  result.mean_sigma = believed > 0 ? sum_of_sigmas / static_cast<double>(believed)
                                   : std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace viewgain
