// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB keeps state in its templates: hidden, each library would have its own (grid/README.md).
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

// One byte a voxel (log_odds_code.hpp); active means not free. Upper nodes span 2048 voxels rather
// than OpenVDB's usual 4096: small maps around the origin touch eight of them, at 33 KB instead of
// 270 KB.
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

/// Empties a tree in this thread. OpenVDB's own destructor first makes a list of the leaves and
/// asks for threads to delete them, and where there is no memory for that the process ends.
template <typename Tree>
void take_down(Tree& tree) noexcept {
  tree.root().clear();
}

/// A tree that is taken down so, whatever throws.
struct OwnCodeTree : CodeTree {
  using CodeTree::CodeTree;
  OwnCodeTree(const OwnCodeTree&) = default;
  ~OwnCodeTree() override { take_down(*this); }
};

/// What a BeliefGrid holds.
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

  /// Unknown fills the workspace grown outward to multiples of 2048 voxels, so that only tiles of
  /// the root arise; whoever reads the tree clips to the workspace. Voxels outside it hold no
  /// meaning.
  OwnCodeTree tree{kUnknownCode};

  BeliefMap beliefs;

  /// Of the blocks, by key, whose scale is not 0. In the tree all voxels of a cell have its code; a
  /// cell's belief is that of its lowest voxel.
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

  /// When what a snapshot tells has changed: a time, and that of each region's last change (by key
  /// >> 6).
  std::uint64_t time = 1;
  std::unordered_map<std::uint64_t, std::uint64_t> changed;
  void mark_changed(std::uint64_t block_key) { changed[block_key >> 6U] = time + 1; }

  /// Tells grids apart. A copy goes its own way from `copied_at` on.
  std::uint64_t number = next_number(), copy_of = 0, copied_at = 0;
  [[nodiscard]] static std::uint64_t next_number();
  /// From now on no snapshot made before counts as one of this grid. Allocates nothing.
  void forget_snapshots() {
    number = next_number();
    copy_of = 0;
  }

  [[nodiscard]] bool is_earlier(const GridSnapshot& snapshot) const {
    return snapshot.grid_number == number ||
           (snapshot.grid_number == copy_of && copy_of != 0 && snapshot.time <= copied_at);
  }

  /// Checks everything, as BeliefGrid's constructor says.
  GridStorage(double voxel_size, const Pose& T_world_grid, double prior_sigma, Index3 min_index,
              Index3 dims);
  GridStorage(const GridStorage&) = default;
  [[nodiscard]] std::unique_ptr<GridStorage> copy() const;

  [[nodiscard]] const BeliefBlock* find_beliefs(std::uint64_t key) const {
    const auto found = beliefs.find(key);
    return found == beliefs.end() ? nullptr : found->second.get();
  }

  /// Memory of all of it [bytes].
  [[nodiscard]] std::uint64_t bytes() const;

  /// Does the block hold something by cells, a leaf, an occupied tile or beliefs?
  [[nodiscard]] bool is_held(std::uint64_t key) const;
  /// Makes the leaf of a block that is one cell a tile.
  void fold_cell(std::uint64_t key);

  /// A leaf of the 512 codes of a block; null if they are a tile.
  [[nodiscard]] static std::unique_ptr<CodeLeaf> make_leaf(Index3 origin,
                                                           const std::uint8_t* codes);
  /// Puts what make_leaf() made of a block whose first code this is.
  void put_leaf(Index3 origin, std::unique_ptr<CodeLeaf> leaf, std::uint8_t code);
  void put_block(Index3 origin, const std::uint8_t* codes) {
    put_leaf(origin, make_leaf(origin, codes), codes[0]);
  }
};

/// The way from a grid to what it holds, and back.
struct GridAccess {
  [[nodiscard]] static GridStorage& storage(BeliefGrid& grid) { return *grid.storage_; }
  [[nodiscard]] static const GridStorage& storage(const BeliefGrid& grid) { return *grid.storage_; }
  [[nodiscard]] static BeliefGrid wrap(std::unique_ptr<GridStorage> storage) {
    return BeliefGrid(std::move(storage));
  }
};

/// Calls leaf(const CodeLeaf&, Index3 origin), without having looked into the leaf, and tile(Index3
/// origin, int size, std::uint8_t code) for all leaves and tiles that overlap the workspace.
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
