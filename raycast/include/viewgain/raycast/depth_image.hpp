// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

/// The depths along the optical axis [m] at which the rays that evaluate() uses end, row by row,
/// for looking at what a gain comes from: every s-th pixel of every s-th row for a pixel stride s;
/// DepthFrame::kOutOfRange where a ray meets nothing. `labels`, if given, becomes what each meets.
/// A camera in an occupied voxel sees from there. Costs a trace of the pose and, with lens
/// distortion, its undoing for every pixel. Thread safe. Throws Error(invalid_argument) for a pose
/// that is not finite or off by more than 1e-3.
[[nodiscard]] VIEWGAIN_EXPORT DepthFrame depth_image(const GainEvaluator& evaluator,
                                                     const Pose& T_world_camera,
                                                     std::vector<RayHit::Kind>* labels = nullptr);

}  // namespace viewgain
