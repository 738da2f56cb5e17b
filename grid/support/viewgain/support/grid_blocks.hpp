// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/block_lattice.hpp"

namespace viewgain {

// The voxels of a grid by blocks, for importers and exporters that do not include OpenVDB. Codes
// are those of log_odds_code.hpp; what lies outside the workspace holds no meaning.

/// Writes the 512 codes of the block at `origin`, which must overlap the workspace.
VIEWGAIN_EXPORT void put_block(BeliefGrid& grid, Index3 origin, const std::uint8_t* codes);

/// Sets all voxels of a cube to one code; `size` is a power of two, 8 or more, and `origin` a
/// multiple of it. Costs a tile where that is possible: for free and unknown, not for occupied.
VIEWGAIN_EXPORT void fill_cube(BeliefGrid& grid, Index3 origin, std::int32_t size,
                               std::uint8_t code);

/// Calls block(origin, codes), codes being valid as long as the grid is not changed, and
/// cube(origin, size, code) for all parts that overlap the workspace, in no certain order. Cubes
/// are aligned to their size, a power of two from 8 to 2048.
VIEWGAIN_EXPORT void visit_grid(
    const BeliefGrid& grid, const std::function<void(Index3, const std::uint8_t*)>& block,
    const std::function<void(Index3, std::int32_t, std::uint8_t)>& cube);

namespace detail {

// For this module alone.

/// The beliefs of the block that holds a voxel of the workspace; null if it has none.
[[nodiscard]] const BeliefBlock* find_beliefs(const BeliefGrid& grid, Index3 voxel);

/// Memory of the grid.
[[nodiscard]] std::uint64_t bytes_of(const BeliefGrid& grid);

}  // namespace detail

}  // namespace viewgain
