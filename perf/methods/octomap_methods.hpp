// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "octomap_tree.hpp"
#include "trace_method.hpp"

namespace viewgain::bench {

/// Two ways over octree_of(task.map), along each ray from its entry into the workspace; a thread
/// takes one pose at a time. T_world_grid must be the identity.
///
/// `octomap_cast_ray`: castRay with ignoreUnknown = false. It returns true at an occupied voxel and
/// false at an unknown one, which is then the end point: both end the ray here.
///
/// `octomap_gain`: what an octree planner does for one view, in the style of
/// ig_active_reconstruction (Isler et al. 2016), written anew on liboctomap. castRay to the first
/// voxel that is not free, computeRayKeys up to it, search for every key, and the sum of the
/// occupancies' entropies -p ln p - (1-p) ln(1-p), an unknown voxel having p = 1/2. trace() gives
/// the voxels that the rays' key lists end in.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_octomap_methods(const TraceTask& task);

}  // namespace viewgain::bench
