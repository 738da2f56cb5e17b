// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// What is probably wrong with frames or poses.
struct VIEWGAIN_EXPORT Suspicion {
  /// Empty: nothing. distortion, principal_point, depth_scale, world_to_camera, quaternion_order,
  /// body_frame, upward_camera, pose_millimetres or depth_along_ray.
  std::string kind{};
  std::string what{};  ///< a sentence with the figure that made it suspicious
};

/// Do frames of one scene fit one another better if their poses or depths are read in another way?
/// Readings of each frame are looked for in the others, as their poses are and under each mistake
/// that is often made; where most of them meet only under a mistake, that is suspected. Says
/// nothing of frames that do not overlap. `T_world_camera`: one a frame, rigid. A dozen frames are
/// enough. Throws Error(invalid_argument) as check_frame_size(), and for another count of poses.
/// Thread safety: may run from many threads. Cost: a pass over the pixels, and 10 ms.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frames(const Sensor& sensor,
                                                       std::span<const DepthFrame> frames,
                                                       std::span<const Pose> T_world_camera);

}  // namespace viewgain
