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
/// same by the surface and by the combined gain, and all three by the tracer embree (`_embree`).
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_viewgain_gains(
    const TraceTask& task, const ScenePointer& scene);

/// Its tracing alone: each tile's endings as the gain takes them.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_trace(const TraceTask& task,
                                                               ScenePointer scene);

/// The same by the tracer embree: a BVH of leaves and boxes, for every tile.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_trace_embree(const TraceTask& task,
                                                                      ScenePointer scene);

/// The same kernel when the leaves that are hit are known beforehand, tile by tile, and so are the
/// tiles that hit nothing: what no way of finding them could beat. Knows the way for task.poses
/// only.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_floor(const TraceTask& task,
                                                               ScenePointer scene);

}  // namespace viewgain::bench
