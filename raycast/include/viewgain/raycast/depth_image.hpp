// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

/// What an evaluator's rays meet, as images, row by row; every s-th pixel of every s-th row for a
/// pixel stride s.
struct VIEWGAIN_EXPORT DepthImage {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  /// width * height, along the optical axis [m]; +infinity: the ray meets nothing.
  std::vector<float> depth;
  std::vector<RayHit::Kind> labels;  ///< width * height: what the ray meets
};

/// The depth and label images of a pose: where the rays that evaluate() uses end, for looking at
/// what a gain comes from. A camera in an occupied voxel sees from there. Costs a trace of the pose
/// and, with lens distortion, its undoing for every pixel. Thread safe. Throws
/// Error(invalid_argument) for a pose that is not finite or off by more than 1e-3.
[[nodiscard]] VIEWGAIN_EXPORT DepthImage depth_image(const GainEvaluator& evaluator,
                                                     const Pose& T_world_camera);

}  // namespace viewgain
