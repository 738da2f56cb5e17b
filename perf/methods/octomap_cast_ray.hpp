// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "octomap_tree.hpp"
#include "trace_method.hpp"

namespace viewgain::bench {

/// OctoMap's castRay with ignoreUnknown = false over octree_of(task.map), from the ray's entry into
/// the workspace. It returns true at an occupied voxel and false at an unknown one, which is then
/// the end point: both end the ray here. T_world_grid must be the identity.
[[nodiscard]] std::unique_ptr<TraceMethod> make_octomap_cast_ray(
    const TraceTask& task, std::shared_ptr<const octomap::OcTree> tree);

}  // namespace viewgain::bench
