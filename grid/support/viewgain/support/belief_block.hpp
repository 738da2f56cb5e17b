// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain {

class BeliefGrid;

/// Calls f(offset) for the voxels of the cell whose lowest voxel has this offset.
template <typename F>
void for_each_in_cell(unsigned lowest, int scale, F&& f) {
  const unsigned edge = 1U << static_cast<unsigned>(scale);
  for (unsigned x = 0; x < edge; ++x) {
    for (unsigned y = 0; y < edge; ++y) {
      for (unsigned z = 0; z < edge; ++z) f(lowest + (x << 6U | y << 3U | z));
    }
  }
}

/// The beliefs of one leaf: those of the voxels in `mask`, or of the cells whose lowest voxels they
/// are, by offset.
struct BeliefBlock {
  LeafMask mask{};              ///< voxels with a belief
  std::uint8_t scale = 0;       ///< of the leaf
  std::vector<Belief> beliefs;  ///< of those, by offset

  /// Index in `beliefs` of the voxel with this offset (x << 6 | y << 3 | z); the bit must be set.
  [[nodiscard]] std::size_t rank(unsigned offset) const {
    int below = 0;
    for (unsigned word = 0; word < offset >> 6U; ++word) below += std::popcount(mask[word]);
    const std::uint64_t low = (std::uint64_t{1} << (offset & 63U)) - 1U;
    return static_cast<std::size_t>(below + std::popcount(mask[offset >> 6U] & low));
  }
  /// The belief of the voxel, or of its cell; null without one.
  [[nodiscard]] const Belief* find(unsigned offset) const {
    offset = cell_offset(offset, scale);
    return test_bit(mask, offset) ? &beliefs[rank(offset)] : nullptr;
  }
};

/// A block of beliefs and its lowest voxel, a multiple of 8.
struct BeliefBlockAt {
  Index3 origin;                               ///< its lowest voxel
  std::shared_ptr<const BeliefBlock> beliefs;  ///< shared with the map

  /// Calls visit(Index3 voxel, const Belief&), voxels in the order [x][y][z] with z fastest.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    std::size_t rank = 0;
    for_each_bit(beliefs->mask, [&](unsigned offset) {
      visit(offset_voxel(origin, offset), beliefs->beliefs[rank++]);
    });
  }
};

/// All beliefs of a map, including those of free voxels, by block in a fixed order; shared, not
/// copied. Cost: one step per block.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BeliefBlockAt> belief_blocks(const BeliefGrid& grid);

}  // namespace viewgain
