// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "evaluator.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain::python {

/// One UserWarning that names all suspicions; none without any. Needs the GIL. Throws
/// py::error_already_set where a filter makes warnings errors.
void warn(std::span<const Suspicion> suspicions);
inline void warn(const Suspicion& suspicion) { warn(std::span(&suspicion, 1)); }

/// What is wrong with poses of which most do not see the scene's map (suspect_poses()). A few
/// microseconds where they do. Runs with or without the GIL.
[[nodiscard]] Suspicion suspicion_of_poses(const std::shared_ptr<const VoxelScene>& scene,
                                           const Sensor& sensor, std::span<const Pose> poses);

/// What is wrong with a frame that shows hardly anything of the grid (suspect_frame()); nothing
/// where `counts` say that it does.
[[nodiscard]] Suspicion suspicion_of_frame(const Sensor& sensor, const DepthFrame& frame,
                                           const Pose& T_world_camera, const BeliefGrid& grid,
                                           const IntegrationReport& counts);

/// What is probably wrong with a scorer's sensor and settings, or with the reach of poses.
[[nodiscard]] std::vector<Suspicion> suspicions_of_set_up(const ViewScorer& scorer,
                                                          const ReachRegion& reach);

}  // namespace viewgain::python
