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

/// A probable fault of frames or poses.
struct VIEWGAIN_EXPORT Suspicion {
  /// Empty: none. Otherwise distortion, principal_point, focal_lengths (fx and fy differ),
  /// depth_scale, world_to_camera, quaternion_order, body_frame, upward_camera, rolled_camera,
  /// pose_millimetres, mirrored, upside_down, numbering, time_offset, depth_along_ray,
  /// focal_length, same_image, support_plane, contradiction (another cause), displacement (frames
  /// are displaced, see FrameCheck), a kind of suspect_set_up.hpp or, for poses alone, no_voxel.
  std::string kind{};
  std::string what{};  ///< a sentence with the number that raised the suspicion
};

/// Checks whether frames of one scene agree better under another convention for poses, images or
/// depths. Compares the surfaces of the frames, first as given and then with each common mistake
/// corrected. Suspects the mistake whose correction makes the frames agree best, or several
/// mistakes if they fit equally. Ignores frames without overlap. Throws Error(invalid_argument) for
/// a wrong number of poses. Also throws whatever check_frame_size() throws. Thread safe. Cost: one
/// pass over the pixels and 50 ms for a dozen frames, 0.5 s if they disagree.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frames(const Sensor& sensor,
                                                       std::span<const DepthFrame> frames,
                                                       std::span<const Pose> T_world_camera);

/// Checks whether candidate poses look at the map. Tries up to a hundred of the poses. If most of
/// them see no voxel of the map, names the mistake in the poses that explains this, or no_voxel if
/// no mistake does. Thread safe. Cost: some milliseconds. Throws like GainEvaluator().
[[nodiscard]] VIEWGAIN_EXPORT Suspicion
suspect_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
              std::span<const Pose> T_world_camera);

}  // namespace viewgain
