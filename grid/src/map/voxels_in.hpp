// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/box.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// The voxels of the workspace whose centres lie in a region of the grid's frame [m], which is half
/// open; its bounds may be infinite. Throws Error(invalid_argument) for a bound that is not a
/// number.
[[nodiscard]] VoxelBox voxels_in(const BeliefGrid& grid, const Box& region);

}  // namespace viewgain::detail
