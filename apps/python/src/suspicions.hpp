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

/// Issues one UserWarning that names all suspicions, if any. Needs the GIL. Throws
/// py::error_already_set if a filter turns warnings into errors.
void warn(std::span<const Suspicion> suspicions);
inline void warn(const Suspicion& suspicion) { warn(std::span(&suspicion, 1)); }

/// What is probably wrong if most poses do not see the scene's map (suspect_poses()). Takes a few
/// microseconds if they do. Runs with or without the GIL.
[[nodiscard]] Suspicion suspicion_of_poses(const std::shared_ptr<const VoxelScene>& scene,
                                           const Sensor& sensor, std::span<const Pose> poses);

/// What is probably wrong with a frame that shows almost nothing of the grid (suspect_frame());
/// empty if `counts` has enough readings inside.
[[nodiscard]] Suspicion suspicion_of_frame(const Sensor& sensor, const DepthFrame& frame,
                                           const Pose& T_world_camera, const BeliefGrid& grid,
                                           const IntegrationReport& counts);

/// What is probably wrong with a scorer's sensor and settings, or with the reach of poses.
[[nodiscard]] std::vector<Suspicion> suspicions_of_set_up(const ViewScorer& scorer,
                                                          const ReachRegion& reach);

}  // namespace viewgain::python
