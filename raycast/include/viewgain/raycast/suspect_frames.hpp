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
  /// Empty: nothing. distortion, principal_point, focal_lengths (fx and fy far apart), depth_scale,
  /// world_to_camera, quaternion_order, body_frame, upward_camera, rolled_camera, pose_millimetres,
  /// mirrored, upside_down, numbering, time_offset, depth_along_ray, focal_length, same_image,
  /// support_plane, contradiction (of another cause), displacement (frames lie beside one another,
  /// see FrameCheck), those of suspect_set_up.hpp or, of poses
  /// alone, no_voxel.
  std::string kind{};
  std::string what{};  ///< a sentence with the figure that made it suspicious
};

/// Do frames of one scene fit one another better if their poses, images or depths are read in
/// another way? Readings of each frame are looked for in the others, as the poses are and under
/// common mistakes; the one by which most lie close is suspected, or several that fit alike. Says
/// nothing of frames that do not overlap. `T_world_camera`: one per frame. Throws
/// Error(invalid_argument) as check_frame_size(), and for another count of poses. Thread safe.
/// Cost: a pass over the pixels and 50 ms for a dozen frames, 0.5 s where they do not fit.
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
