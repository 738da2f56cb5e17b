// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB keeps state in its templates; with hidden visibility each library would have a copy
// (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/Exceptions.h>
#include <openvdb/tree/InternalNode.h>
#include <openvdb/tree/LeafNode.h>
#include <openvdb/tree/RootNode.h>
#include <openvdb/tree/Tree.h>
#pragma GCC visibility pop

#include <memory>
#include <unordered_map>
#include <vector>

#include "belief_blocks.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain::detail {

// One byte per voxel (log_odds_code.hpp); active means not free. Upper nodes span 2048 voxels
// instead of OpenVDB's usual 4096: small maps around the origin touch eight of them, at 33 KB
// instead of 270 KB.
using CodeTree = openvdb::tree::Tree4<std::uint8_t, 4, 4, 3>::Type;
using CodeLeaf = CodeTree::LeafNodeType;
using CodeUpper = CodeTree::RootNodeType::ChildNodeType;
using CodeNode = CodeUpper::ChildNodeType;
static_assert(CodeLeaf::DIM == kBlockSize && CodeNode::DIM == kNodeSize);

// Levels of OpenVDB's tiles by their size: 8³ in nodes, 128³ in upper nodes, 2048³ in the root.
inline constexpr openvdb::Index kBlockTileLevel = 1;
inline constexpr openvdb::Index kNodeTileLevel = 2;

[[nodiscard]] inline openvdb::Coord to_coord(Index3 v) { return {v.x, v.y, v.z}; }
[[nodiscard]] inline Index3 to_index(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

[[nodiscard]] inline LeafMask leaf_mask(const CodeLeaf::NodeMaskType& mask) {
  LeafMask words;
  for (openvdb::Index i = 0; i < 8; ++i) words[i] = mask.getWord<std::uint64_t>(i);
  return words;
}

/// Clears a tree in this thread. OpenVDB's own destructor first lists the leaves and requests
/// threads to delete them; without memory for that the process ends.
template <typename Tree>
void take_down(Tree& tree) noexcept {
  tree.root().clear();
}

/// A tree that is always cleared this way, also on exceptions.
struct OwnCodeTree : CodeTree {
  using CodeTree::CodeTree;
  OwnCodeTree(const OwnCodeTree&) = default;
  ~OwnCodeTree() override { take_down(*this); }
};

/// Contents of a BeliefGrid.
struct GridStorage {
  double voxel_size = 0;
  Pose T_world_grid;
  double prior_sigma = 0;
  Index3 min_index;
  Index3 dims;
  BlockLattice lattice;
  std::vector<Pose> views;
  HazardCounters hazard;
  MapNotes notes;

  /// Unknown space fills the workspace extended to multiples of 2048 voxels, so that only root
  /// tiles arise; readers of the tree clip to the workspace. Voxels outside are undefined.
  OwnCodeTree tree{kUnknownCode};

  BeliefMap beliefs;

  /// Nonzero scales by block key. In the tree all voxels of a cell have its code; a cell's belief
  /// is stored at its lowest voxel.
  std::unordered_map<std::uint64_t, std::uint8_t> scales;
  [[nodiscard]] int scale(std::uint64_t key) const {
    if (scales.empty()) return 0;
    const auto found = scales.find(key);
    return found == scales.end() ? 0 : found->second;
  }
  void put_scale(std::uint64_t key, int scale) {
    if (scale > 0) {
      scales[key] = static_cast<std::uint8_t>(scale);
    } else {
      scales.erase(key);
    }
  }

  /// Times of changes that affect snapshots: of the grid, and of each region's last change (by key
  /// >> 6).
  std::uint64_t time = 1;
  std::unordered_map<std::uint64_t, std::uint64_t> changed;
  void mark_changed(std::uint64_t block_key) { changed[block_key >> 6U] = time + 1; }

  /// Identifies grids. A copy diverges from `copied_at` on.
  std::uint64_t number = next_number(), copy_of = 0, copied_at = 0;
  [[nodiscard]] static std::uint64_t next_number();
  /// Invalidates all earlier snapshots. Does not allocate.
  void forget_snapshots() {
    number = next_number();
    copy_of = 0;
  }

  [[nodiscard]] bool is_earlier(const GridSnapshot& snapshot) const {
    return snapshot.grid_number == number ||
           (snapshot.grid_number == copy_of && copy_of != 0 && snapshot.time <= copied_at);
  }

  /// Checks everything, as BeliefGrid's constructor documents.
  GridStorage(double voxel_size, const Pose& T_world_grid, double prior_sigma, Index3 min_index,
              Index3 dims);
  GridStorage(const GridStorage&) = default;
  [[nodiscard]] std::unique_ptr<GridStorage> copy() const;

  [[nodiscard]] const BeliefBlock* find_beliefs(std::uint64_t key) const {
    const auto found = beliefs.find(key);
    return found == beliefs.end() ? nullptr : found->second.get();
  }

  /// Total memory [bytes].
  [[nodiscard]] std::uint64_t bytes() const;

  /// Whether the block stores anything by cells: a leaf, an occupied tile or beliefs.
  [[nodiscard]] bool is_held(std::uint64_t key) const;
  /// Converts the leaf of a block that is one cell to a tile.
  void fold_cell(std::uint64_t key);

  /// A leaf with the 512 codes of a block; null if they form a tile.
  [[nodiscard]] static std::unique_ptr<CodeLeaf> make_leaf(Index3 origin,
                                                           const std::uint8_t* codes);
  /// Inserts the result of make_leaf() for a block with this first code.
  void put_leaf(Index3 origin, std::unique_ptr<CodeLeaf> leaf, std::uint8_t code);
  void put_block(Index3 origin, const std::uint8_t* codes) {
    put_leaf(origin, make_leaf(origin, codes), codes[0]);
  }
};

/// Access from a grid to its contents and back.
struct GridAccess {
  [[nodiscard]] static GridStorage& storage(BeliefGrid& grid) { return *grid.storage_; }
  [[nodiscard]] static const GridStorage& storage(const BeliefGrid& grid) { return *grid.storage_; }
  [[nodiscard]] static BeliefGrid wrap(std::unique_ptr<GridStorage> storage) {
    return BeliefGrid(std::move(storage));
  }
};

/// Calls leaf(const CodeLeaf&, Index3 origin), without reading the leaf, and tile(Index3 origin,
/// int size, std::uint8_t code) for all leaves and tiles that overlap the workspace.
template <typename LeafFn, typename TileFn>
void visit_blocks(const GridStorage& storage, LeafFn&& leaf, TileFn&& tile) {
  const BlockLattice& lattice = storage.lattice;
  const auto visit_tile = [&](const openvdb::Coord& at, int size, std::uint8_t code) {
    if (lattice.overlaps(to_index(at), size)) tile(to_index(at), size, code);
  };
  const auto& root = storage.tree.root();
  for (auto it = root.cbeginValueAll(); it; ++it) {
    visit_tile(it.getCoord(), static_cast<int>(CodeUpper::DIM), *it);
  }
  for (auto upper = root.cbeginChildOn(); upper; ++upper) {
    for (auto it = upper->cbeginValueAll(); it; ++it) {
      visit_tile(it.getCoord(), static_cast<int>(CodeNode::DIM), *it);
    }
    for (auto node = upper->cbeginChildOn(); node; ++node) {
      for (auto it = node->cbeginValueAll(); it; ++it) visit_tile(it.getCoord(), kBlockSize, *it);
      for (auto it = node->cbeginChildOn(); it; ++it) {
        const Index3 origin = to_index(it.getCoord());
        if (lattice.overlaps(origin, kBlockSize)) leaf(*it, origin);
      }
    }
  }
}

}  // namespace viewgain::detail
