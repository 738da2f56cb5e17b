// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>

#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {

/// By BlockLattice::key. Blocks are never changed in place: snapshots and clones share them.
using BeliefMap = std::unordered_map<std::uint64_t, std::shared_ptr<const BeliefBlock>>;

/// The grid's own.
[[nodiscard]] const BeliefMap& beliefs_of(const BeliefGrid& grid);
/// Of the block with this key.
[[nodiscard]] int scale_of(const BeliefGrid& grid, std::uint64_t key);
[[nodiscard]] bool has_scales(const BeliefGrid& grid);  ///< that are not 0
/// Does the block hold something by cells: a leaf, an occupied tile or beliefs?
[[nodiscard]] bool is_held(const BeliefGrid& grid, std::uint64_t key);
/// Gives a block the largest scale up to this one that fits, with what it holds.
void set_scale(BeliefGrid& grid, std::uint64_t key, int scale);

inline constexpr int kMaxScale = 3;  // a cell is at most a leaf

/// The largest scale up to `scale` with which no cell of the block lies across the workspace's
/// face.
[[nodiscard]] int fitting_scale(const BlockLattice& lattice, Index3 origin, int scale);

/// Which voxels of the block are occupied. `origin` is a multiple of 8. Reads only the grid.
[[nodiscard]] LeafMask occupied_in(const BeliefGrid& grid, Index3 origin);

/// A copy of `block` (may be null) with room, and zero beliefs, for the voxels of `mask` that it
/// lacks; those that `mask` lacks are dropped. Blocks are never changed in place: snapshots may
/// hold the old one.
[[nodiscard]] std::shared_ptr<BeliefBlock> reshaped(const BeliefBlock* block, const LeafMask& mask);

/// What is wrong with a belief that readings in a voxel cannot have made ("has an information of
/// nan"); empty if it may be one. Its numbers must be finite, its information positive semidefinite
/// but for the rounding of its sums, its place no more than 2^28 voxels off, its hits at most
/// 2^31 - 1.
[[nodiscard]] std::string fault_of_belief(const Belief& belief, double voxel_size);

}  // namespace viewgain::detail
