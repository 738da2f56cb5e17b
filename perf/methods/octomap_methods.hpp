// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "octomap_tree.hpp"
#include "trace_method.hpp"

namespace viewgain::bench {

/// Two methods on octree_of(task.map), along each ray from its entry into the workspace. Each
/// thread processes one pose at a time. T_world_grid must be the identity.
///
/// `octomap_cast_ray`: castRay with ignoreUnknown = false. It returns true at an occupied voxel,
/// and false at an unknown one, which is then the end point. Both end the ray.
///
/// `octomap_gain`: the gain of one view by an octree planner in the style of
/// ig_active_reconstruction (Isler et al. 2016), reimplemented on liboctomap. It calls castRay to
/// the first voxel that is not free, computeRayKeys up to it, and search for every key. The gain is
/// the sum of the entropies -p ln p - (1-p) ln(1-p), with p = 1/2 for unknown voxels. trace()
/// returns the last voxel of each ray's key list.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_octomap_methods(const TraceTask& task);

}  // namespace viewgain::bench
