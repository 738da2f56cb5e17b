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

/// A probable fault of frames, poses or settings.
struct VIEWGAIN_EXPORT Suspicion {
  /// Name of the fault; empty if nothing is suspected. suspect_frames() and FrameCheck use:
  /// distortion, principal_point, focal_lengths (fx and fy differ), depth_scale, world_to_camera,
  /// quaternion_order, body_frame, upward_camera, rolled_camera, pose_millimetres, mirrored,
  /// upside_down, numbering, time_offset, depth_along_ray, focal_length, same_image, support_plane,
  /// contradiction (unknown cause) and displacement (frames are displaced). suspect_poses() also
  /// uses no_voxel. The functions of suspect_set_up.hpp list their own kinds.
  std::string kind{};
  std::string what{};  ///< sentence for the user, with the number that is suspicious
};

/// Checks whether frames of one scene agree better under another convention for poses, images or
/// depths. Compares the surfaces of the frames as given, and with each common mistake corrected.
/// Suspects the mistake whose correction makes the frames agree best, or several if they fit
/// equally. Ignores frames without overlap. Throws Error(invalid_argument) if the number of poses
/// is wrong. Also throws whatever check_frame_size() throws. Thread safe. Cost for a dozen frames:
/// 50 ms; 0.5 s if they disagree.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frames(const Sensor& sensor,
                                                       std::span<const DepthFrame> frames,
                                                       std::span<const Pose> T_world_camera);

/// Checks whether candidate poses look at the map. Tries up to a hundred of the poses. If most of
/// them see no voxel of the map, suspects the common mistake that explains this, or no_voxel if
/// none does. Thread safe. Throws whatever the constructor of GainEvaluator throws. Cost: some
/// milliseconds.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion
suspect_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
              std::span<const Pose> T_world_camera);

}  // namespace viewgain
