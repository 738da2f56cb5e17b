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

/// By BlockLattice::key. Blocks are immutable: snapshots and clones share them.
using BeliefMap = std::unordered_map<std::uint64_t, std::shared_ptr<const BeliefBlock>>;

/// Belief blocks of the grid.
[[nodiscard]] const BeliefMap& beliefs_of(const BeliefGrid& grid);
/// Scale of the block with this key.
[[nodiscard]] int scale_of(const BeliefGrid& grid, std::uint64_t key);
[[nodiscard]] bool has_scales(const BeliefGrid& grid);  ///< nonzero scales
/// Whether the block stores anything by cells: a leaf, an occupied tile or beliefs.
[[nodiscard]] bool is_held(const BeliefGrid& grid, std::uint64_t key);
/// Sets the largest scale up to this one that fits a block, and converts its contents.
void set_scale(BeliefGrid& grid, std::uint64_t key, int scale);

inline constexpr int kMaxScale = 3;  // a cell is at most a leaf

/// Largest scale up to `scale` at which no cell of the block crosses the workspace's face.
[[nodiscard]] int fitting_scale(const BlockLattice& lattice, Index3 origin, int scale);

/// Occupied voxels of the block at `origin`, a multiple of 8. Only reads the grid.
[[nodiscard]] LeafMask occupied_in(const BeliefGrid& grid, Index3 origin);

/// A copy of `block` (or null) with zero beliefs added for voxels of `mask` and others dropped.
/// Blocks are immutable, because snapshots may hold the old one.
[[nodiscard]] std::shared_ptr<BeliefBlock> reshaped(const BeliefBlock* block, const LeafMask& mask);

/// Fault of a belief that readings in a voxel cannot produce ("has an information of nan"), or
/// empty. Numbers must be finite, information positive semidefinite up to rounding, the position at
/// most 2^28 voxels away, and hits at most 2^31 - 1.
[[nodiscard]] std::string fault_of_belief(const Belief& belief, double voxel_size);

}  // namespace viewgain::detail
