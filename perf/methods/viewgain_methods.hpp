// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::bench {

using ScenePointer = std::shared_ptr<const VoxelScene>;

/// GainEvaluator::evaluate on a batch by the gain paper (`viewgain_gain`), surface and combined,
/// and all three with the tracer embree (`_embree`). Includes tracing, sums by voxel and entropies.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_viewgain_gains(
    const TraceTask& task, const ScenePointer& scene);

/// The tracing of paper alone: the endings of each tile in the form that the gain uses.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_trace(const TraceTask& task,
                                                               ScenePointer scene);

/// The same with the tracer embree: a BVH of leaves and boxes, for every tile.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_trace_embree(const TraceTask& task,
                                                                      ScenePointer scene);

/// The same kernel if the leaves that each tile hits, and the tiles that hit nothing, are known
/// beforehand: a lower bound on time for any method of finding them. Only for task.poses.
[[nodiscard]] std::unique_ptr<TraceMethod> make_viewgain_floor(const TraceTask& task,
                                                               ScenePointer scene);

}  // namespace viewgain::bench
