// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "octomap/octomap_format.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain::detail {

/// Voxels to move the grid by, so that the tree's frame is the world's; nothing where that is no
/// whole number of them, turns, or leaves a tree's space.
[[nodiscard]] std::optional<Index3> shift_to_world(const BeliefGrid& grid);

/// A part of the tree: a block's codes, or a uniform cube.
struct OctomapPart {
  std::uint64_t place = 0;  ///< of the lowest voxel on the curve of children's numbers
  int level = 0;            ///< the size is 2^level voxels
  std::uint8_t code = kUnknownCode;
  const std::uint8_t* codes = nullptr;
};

/// A grid as cubes of the tree. The tree's cubes start at multiples of their size from a corner
/// that is shifted against the grid's, so the grid's own blocks and tiles, clipped to the
/// workspace, are cut where a cube of the tree ends. Cost: pieces of the grid times levels of the
/// tree.
class OctomapParts {
 public:
  /// Throws Error(capacity) if a known block lies outside of a tree's space. The grid must stay as
  /// it is as long as the parts are used.
  OctomapParts(const BeliefGrid& grid, Index3 shift);

  /// In the order of their places.
  [[nodiscard]] std::span<const OctomapPart> parts() const { return parts_; }

 private:
  /// The part of a block or tile of the grid that lies in the workspace: [min, max), in voxels from
  /// the lowest corner of the tree's space.
  struct Piece {
    Index3 min, max;
    std::uint8_t code;
    const std::uint8_t* codes;  ///< of a block, else null
    Index3 origin;              ///< of the block
  };
  using Pieces = std::vector<std::size_t>;

  void add_block(Index3 origin, const std::uint8_t* codes);
  void add_piece(Index3 origin, std::int32_t size, std::uint8_t code, const std::uint8_t* codes);
  void cut(Index3 at, int level, const Pieces& inside);
  [[nodiscard]] std::uint8_t uniform_code(Index3 at, std::int32_t size, const Pieces& inside) const;
  void add_codes(Index3 at, const Pieces& inside);

  BlockLattice lattice_;
  Index3 shift_;
  std::vector<Piece> pieces_;
  /// By level, those that reach into each child of the cube that is being cut.
  std::array<std::array<Pieces, 8>, kOctomapLevels + 1> pieces_at_;
  std::vector<OctomapPart> parts_;
  std::deque<std::array<std::uint8_t, kBlockVoxels>> cut_codes_;
};

}  // namespace viewgain::detail
