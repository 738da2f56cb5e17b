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
/// Numbers that are allowed and seldom meant, mostly lengths in millimetres. Suspicion::what states
/// the number and the likely unit; without an objection a single Suspicion has an empty kind. All
/// functions only look at numbers, throw nothing for valid input, and may run from many threads.

namespace viewgain {

/// Compares a sensor's numbers with one another and with the voxel size [m], if one is given.
/// Kinds: field_of_view, range_unit, noise_unit, time_unit, frequency_unit, pose_sigma_unit,
/// scale_sigma, calibration_unit, body_unit, mounting_unit; the first one explains the most.
/// Costs some microseconds.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Suspicion> suspect_sensor(
    const Sensor& sensor, std::optional<double> voxel_size = {});

/// Does the suspicion explain by itself why frames do not fit one another (field_of_view,
/// range_unit)?
[[nodiscard]] VIEWGAIN_EXPORT bool explains_frames(const Suspicion& suspicion);

/// Compares the uncertainty of poses with the working distance and the voxel size [m]; kind
/// pose_sigma_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_pose_sigma(const PoseSigma& sigma,
                                                           double working_distance,
                                                           std::optional<double> voxel_size = {});

/// Compares the map's workspace and voxel size with the sensor's range; kind workspace_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_workspace(const BeliefGrid& map,
                                                          const Sensor& sensor);

/// Is an obstacle with these bounds [m, world] out of the reach of views of the map, or 100 times
/// as long as the map? Kind obstacle_unit; `what` is a predicate ("is 900 m long ...").
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_obstacle(const Box& bounds, const BeliefGrid& map,
                                                         const Sensor& sensor);
/// The bounds of a mesh, for suspect_obstacle(); of no vertex a box at the origin. O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT Box obstacle_bounds(const TriangleMesh& mesh);

/// Are most views of a map inside of solid obstacles, as of a closed mesh of the room's walls? Then
/// no view is possible. Kind views_in_obstacle. Builds a BVH of the obstacles. Throws as
/// VoxelScene::build().
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_solid_obstacles(const Obstacles& obstacles,
                                                                std::span<const Pose> views);

/// Is the map out of sight from everywhere in the region's boxes, shells and poses? Kind
/// reach_unit. O(parts).
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_reach(const ReachRegion& reach,
                                                      const BeliefGrid& map, const Sensor& sensor);

/// Is a table at height z [m] farther from the map than a view of it sees? Kind plane_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_support_plane(double z, const BeliefGrid& map,
                                                              const Sensor& sensor);

/// Is an object of this longest side [m] 10 times as long as the workspace, or smaller than a
/// voxel? Kind object_size_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_object_size(double size, const BeliefGrid& map);

/// Is a clearance [m] round the body larger than every body? Kind clearance_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_clearance(double clearance);

/// Do the frusta of more than half of a hundred of the poses miss the map's workspace? The quick
/// question before suspect_poses(), for every batch of poses. Poses that are not rigid do not
/// count. 50 rays per pose: a microsecond each.
[[nodiscard]] VIEWGAIN_EXPORT bool mostly_look_away(const GridSnapshot& map, const Sensor& sensor,
                                                    std::span<const Pose> T_world_camera);

/// Does a frame see nothing of the map at its pose, but the workspace by a common mistake in poses
/// or depths? Kinds as suspect_frames(). Needs one frame, where suspect_frames() compares several.
/// Looks at 1,000 pixels: 0.2 ms.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frame(const Sensor& sensor, const DepthFrame& frame,
                                                      const Pose& T_world_camera,
                                                      const BeliefGrid& map);

/// What masks took from frames. `unmasked` and `masked` are the same frames before and after.
/// Suspects masks that took 95 % of the readings in the map's workspace (anywhere without a map),
/// or the middle of the images and little else: kind masks. Costs a pass over the pixels. Throws
/// Error(invalid_argument) for spans of different lengths, and as check_frame_size().
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_masks(const Sensor& sensor,
                                                      std::span<const DepthFrame> unmasked,
                                                      std::span<const DepthFrame> masked,
                                                      std::span<const Pose> T_world_camera,
                                                      const BeliefGrid* map = nullptr);

}  // namespace viewgain
