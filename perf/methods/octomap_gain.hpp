// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "octomap_tree.hpp"
#include "trace_method.hpp"

namespace viewgain::bench {

/// What an octree planner does for one view, in the style of ig_active_reconstruction (Isler et al.
/// 2016), written anew on liboctomap: along each ray castRay to the first voxel that is not free,
/// computeRayKeys up to it, search for every key, and the sum of the occupancies' entropies
/// -p ln p - (1-p) ln(1-p), an unknown voxel having p = 1/2. `tree`: octree_of(task.map). From the
/// ray's entry into the workspace; a thread scores one pose at a time. trace() gives the voxels
/// that the rays' key lists end in. T_world_grid must be the identity.
[[nodiscard]] std::unique_ptr<TraceMethod> make_octomap_gain(
    const TraceTask& task, std::shared_ptr<const octomap::OcTree> tree);

}  // namespace viewgain::bench
