// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>

#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

/// By BlockLattice::key. Blocks are never changed in place: snapshots and clones share them.
using BeliefMap = std::unordered_map<std::uint64_t, std::shared_ptr<const BeliefBlock>>;

/// The grid's own.
[[nodiscard]] const BeliefMap& beliefs_of(const BeliefGrid& grid);

/// Which voxels of the block are occupied. `origin` is a multiple of 8. Reads only the grid.
[[nodiscard]] LeafMask occupied_in(const BeliefGrid& grid, Index3 origin);

/// A copy of `block` (may be null) with room, and zero beliefs, for the voxels of `mask` that it
/// lacks; those that `mask` lacks are dropped. Blocks are never changed in place: snapshots may
/// hold the old one.
[[nodiscard]] std::shared_ptr<BeliefBlock> reshaped(const BeliefBlock* block, const LeafMask& mask);

}  // namespace viewgain::detail
