// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::bench {

using ScenePointer = std::shared_ptr<const VoxelScene>;

/// GainEvaluator::evaluate on a batch: tracing, sums by voxel, entropies (`viewgain_gain`); the
/// same by the surface and by the combined gain.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_viewgain_gains(
    const TraceTask& task, const ScenePointer& scene);

/// Its tracing alone: each tile's endings as the gain takes them.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_trace(const TraceTask& task,
                                                               ScenePointer scene);

/// The same kernel through Embree's BVH for every tile, as with VIEWGAIN_TRACE=bvh.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_trace_bvh(const TraceTask& task,
                                                                   ScenePointer scene);

/// The same kernel when the leaves that are hit are known beforehand, tile by tile, and so are the
/// tiles that hit nothing: what no way of finding them could beat. Knows the way for task.poses
/// only.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_floor(const TraceTask& task,
                                                               ScenePointer scene);

}  // namespace viewgain::bench
