// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::detail {

/// The voxels of a workspace.
struct GridLayout {
  Index3 min_index;
  Index3 dims;
};

/// The box of whole voxels around the workspace. Throws like BeliefGrid's constructor.
[[nodiscard]] GridLayout layout_of(const GridConfig& config);

/// Throws like BeliefGrid's constructor.
void check_layout(double voxel_size, const Pose& T_world_grid, double prior_sigma,
                  const GridLayout& layout);

/// Throws Error(invalid_argument) for a count that is negative or above 2^40.
void check_counters(const HazardCounters& counters);

/// The voxels of the workspace whose centres lie in a half-open region of the grid frame [m];
/// bounds may be infinite. Throws Error(invalid_argument) for a bound that is NaN.
[[nodiscard]] VoxelBox voxels_in(const BeliefGrid& grid, const Box& region);

/// A camera pose made rigid by rigid_pose(). Throws Error(invalid_argument) if that fails.
[[nodiscard]] Pose rigid_view(const Pose& T_world_camera);

}  // namespace viewgain::detail
