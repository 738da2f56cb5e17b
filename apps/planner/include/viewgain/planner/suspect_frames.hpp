// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// What is probably wrong with frames or poses.
struct VIEWGAIN_EXPORT Suspicion {
  /// Empty: nothing. distortion, principal_point, depth_scale, world_to_camera, quaternion_order,
  /// body_frame, upward_camera, pose_millimetres, depth_along_ray, focal_length, those of
  /// suspect_set_up.hpp or, of poses alone, no_voxel.
  std::string kind{};
  std::string what{};  ///< a sentence with the figure that made it suspicious
};

/// Do frames of one scene fit one another better if their poses or depths are read in another way,
/// or by another focal length?
/// Readings of each frame are looked for in the others, as their poses are and under each mistake
/// that is often made; where most of them meet only under a mistake, that is suspected, and of
/// several the one by which most lie close. Scales are tried that are off by a factor of 2, 2.5,
/// 4, 5, 10 or 1000, focal lengths from 0.5 to 2 times the stated one; of a scale and a focal
/// length that fit alike both are named. Says nothing of frames that do not overlap.
/// `T_world_camera`: one a frame, rigid. A dozen frames are enough. Throws Error(invalid_argument)
/// as check_frame_size(), and for another count of poses. Thread safety: may run from many threads.
/// Cost: a pass over the pixels, and up to 0.3 s.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frames(const Sensor& sensor,
                                                       std::span<const DepthFrame> frames,
                                                       std::span<const Pose> T_world_camera);

/// Do candidate poses look at the map? Where most of a hundred of them see none of its voxels, and
/// by which mistake in poses that would come; no_voxel if by none. Thread safety: may run from many
/// threads. Cost: some milliseconds. Throws as GainEvaluator().
[[nodiscard]] VIEWGAIN_EXPORT Suspicion
suspect_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
              std::span<const Pose> T_world_camera);

}  // namespace viewgain
