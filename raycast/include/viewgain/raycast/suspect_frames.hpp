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
  std::string what{};  ///< a sentence with the figure that raised the suspicion
};

/// Whether frames of one scene agree better if their poses, images or depths follow another
/// convention. Searches for the readings of each frame in the others, as given and under common
/// mistakes; suspects the mistake under which most readings are close, or several that fit equally.
/// Ignores frames without overlap. `T_world_camera`: one per frame. Throws Error(invalid_argument)
/// as check_frame_size(), and for a wrong number of poses. Thread safe. Cost: one pass over the
/// pixels and 50 ms for a dozen frames, 0.5 s if they disagree.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frames(const Sensor& sensor,
                                                       std::span<const DepthFrame> frames,
                                                       std::span<const Pose> T_world_camera);

/// Whether candidate poses look at the map. If most of a hundred of them see none of its voxels,
/// names the mistake in poses under which they would; no_voxel if there is none. Thread safe. Cost:
/// some milliseconds. Throws as GainEvaluator().
[[nodiscard]] VIEWGAIN_EXPORT Suspicion
suspect_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
              std::span<const Pose> T_world_camera);

}  // namespace viewgain
