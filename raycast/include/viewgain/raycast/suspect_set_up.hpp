// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/raycast/suspect_frames.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

/// @file
/// Checks for values that are allowed but rarely meant, mostly lengths in millimetres.
/// Suspicion::what states the value and the likely unit. A Suspicion with an empty kind means that
/// nothing is suspected. All functions only compare numbers, throw nothing for valid input, and may
/// run from many threads.

namespace viewgain {

/// Compares a sensor's values with each other and with the voxel size [m], if given. Kinds:
/// field_of_view, range_unit, noise_unit, time_unit, frequency_unit, pose_sigma_unit, scale_sigma,
/// calibration_unit, body_unit, mounting_unit. Most likely first. Cost: some microseconds.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Suspicion> suspect_sensor(
    const Sensor& sensor, std::optional<double> voxel_size = {});

/// Whether the suspicion alone can explain that frames disagree (field_of_view, range_unit).
[[nodiscard]] VIEWGAIN_EXPORT bool explains_frames(const Suspicion& suspicion);

/// Compares the uncertainty of poses with the working distance and the voxel size [m]; kind
/// pose_sigma_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_pose_sigma(const PoseSigma& sigma,
                                                           double working_distance,
                                                           std::optional<double> voxel_size = {});

/// Compares the map's workspace and voxel size with the sensor's range; kind workspace_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_workspace(const BeliefGrid& map,
                                                          const Sensor& sensor);

/// Whether an obstacle with these bounds [m, world] is too far away for views of the map, or 100
/// times as long as the map. Kind obstacle_unit; `what` has no subject ("is 900 m long ...").
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_obstacle(const Box& bounds, const BeliefGrid& map,
                                                         const Sensor& sensor);
/// Bounds of a mesh, for suspect_obstacle(); without vertices a box at the origin. O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT Box obstacle_bounds(const TriangleMesh& mesh);

/// Whether most views of a map lie inside solid obstacles, such as a closed mesh of the room's
/// walls, so that no view is possible. Kind views_in_obstacle. Builds a BVH of the obstacles.
/// Throws like VoxelScene::build().
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_solid_obstacles(const Obstacles& obstacles,
                                                                std::span<const Pose> views);

/// Whether the map is out of sight from all boxes, shells and poses of the region. Kind reach_unit.
/// O(parts).
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_reach(const ReachRegion& reach,
                                                      const BeliefGrid& map, const Sensor& sensor);

/// Whether a table at height z [m] is too far from the map to be seen by its views. Kind
/// plane_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_support_plane(double z, const BeliefGrid& map,
                                                              const Sensor& sensor);

/// Whether an object with this longest side [m] is 10 times as long as the workspace, or smaller
/// than a voxel. Kind object_size_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_object_size(double size, const BeliefGrid& map);

/// Whether a clearance [m] around the body exceeds any body. Kind clearance_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_clearance(double clearance);

/// Whether most poses look past the map's workspace: more than half of up to a hundred of them. A
/// quick check before suspect_poses(). Ignores poses that are not rigid. Cost: 50 microseconds per
/// pose.
[[nodiscard]] VIEWGAIN_EXPORT bool mostly_look_away(const GridSnapshot& map, const Sensor& sensor,
                                                    std::span<const Pose> T_world_camera);

/// Whether a frame sees nothing of the map at its pose, but would see the workspace under a common
/// mistake in poses or depths. The kinds are those of suspect_frames(), which compares several
/// frames. Cost: 0.2 ms.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frame(const Sensor& sensor, const DepthFrame& frame,
                                                      const Pose& T_world_camera,
                                                      const BeliefGrid& map);

/// Whether masks remove too much. `unmasked` and `masked` are the same frames before and after
/// masking. Suspects masks that remove 95 % of the measured depths in the map's workspace (without
/// a map: everywhere), or the middle of the images and little else. Kind masks. Throws
/// Error(invalid_argument) for spans of different lengths. Also throws whatever check_frame_size()
/// throws. Cost: one pass over the pixels.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_masks(const Sensor& sensor,
                                                      std::span<const DepthFrame> unmasked,
                                                      std::span<const DepthFrame> masked,
                                                      std::span<const Pose> T_world_camera,
                                                      const BeliefGrid* map = nullptr);

}  // namespace viewgain
