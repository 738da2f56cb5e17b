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
/// Checks for values that are allowed but probably wrong, mostly lengths in millimetres instead of
/// metres. A comment "Kind x" states Suspicion::kind if the check fails; otherwise the kind is
/// empty. Suspicion::what states the value and the likely unit. The functions do not throw for
/// valid arguments, unless stated otherwise. They may run from many threads.

namespace viewgain {

/// Compares the values of a sensor with each other and, if given, with the voxel size [m]. Kinds:
/// field_of_view, range_unit, noise_unit, time_unit, frequency_unit, pose_sigma_unit, scale_sigma,
/// calibration_unit, body_unit, mounting_unit. The most likely suspicion comes first. Cost: some
/// microseconds.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Suspicion> suspect_sensor(
    const Sensor& sensor, std::optional<double> voxel_size = {});

/// Whether this suspicion (field_of_view or range_unit) can explain why frames disagree.
[[nodiscard]] VIEWGAIN_EXPORT bool explains_frames(const Suspicion& suspicion);

/// Compares the uncertainty of poses with the working distance [m] and the voxel size [m]. Kind
/// pose_sigma_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_pose_sigma(const PoseSigma& sigma,
                                                           double working_distance,
                                                           std::optional<double> voxel_size = {});

/// Compares the map's workspace and voxel size with the range of the sensor. Kind workspace_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_workspace(const BeliefGrid& map,
                                                          const Sensor& sensor);

/// Suspects an obstacle that is too far away for views of the map, or more than 100 times as long
/// as the map. `bounds` are those of the obstacle, world frame [m]. Kind obstacle_unit.
/// Suspicion::what has no subject, for example "is 900 m long ...".
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_obstacle(const Box& bounds, const BeliefGrid& map,
                                                         const Sensor& sensor);
/// Bounding box of a mesh, for suspect_obstacle(). If the mesh has no vertices, it is a box at the
/// origin. O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT Box obstacle_bounds(const TriangleMesh& mesh);

/// Suspects obstacles if most views lie inside solid ones, such as a closed mesh of the room's
/// walls, so that no view is possible. Kind views_in_obstacle. Throws whatever VoxelScene::build()
/// throws. Cost: builds a bounding volume hierarchy of the obstacles.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_solid_obstacles(const Obstacles& obstacles,
                                                                std::span<const Pose> views);

/// Suspects the reach if the map is out of sight from all its boxes, shells and poses. Kind
/// reach_unit. Cost: linear in their number.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_reach(const ReachRegion& reach,
                                                      const BeliefGrid& map, const Sensor& sensor);

/// Suspects a table at height z [m] that is too far from the map to be seen from its views. Kind
/// plane_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_support_plane(double z, const BeliefGrid& map,
                                                              const Sensor& sensor);

/// Suspects an object that is more than 10 times as long as the workspace, or smaller than a voxel.
/// `size` is its longest side [m]. Kind object_size_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_object_size(double size, const BeliefGrid& map);

/// Suspects a clearance [m] that is larger than any camera body. Kind clearance_unit.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_clearance(double clearance);

/// Whether more than half of the poses look past the map's workspace. Tries up to a hundred poses,
/// and ignores poses that are not rigid. A quick check before suspect_poses(). Cost: 50
/// microseconds per pose.
[[nodiscard]] VIEWGAIN_EXPORT bool mostly_look_away(const GridSnapshot& map, const Sensor& sensor,
                                                    std::span<const Pose> T_world_camera);

/// Suspects a mistake in pose or depths if the frame shows nothing of the map's workspace, but
/// would do so with the mistake corrected. Kinds: those of suspect_frames(), which compares several
/// frames. Cost: 0.2 ms.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_frame(const Sensor& sensor, const DepthFrame& frame,
                                                      const Pose& T_world_camera,
                                                      const BeliefGrid& map);

/// Suspects masks that remove at least 95 % of the measured depths in the map's workspace, or the
/// middle of the images and little else. If `map` is null, all measured depths count. `unmasked`
/// and `masked` are the same frames before and after masking. Kind masks. Throws
/// Error(invalid_argument) if the spans differ in length. Also throws whatever check_frame_size()
/// throws. Cost: one pass over the pixels.
[[nodiscard]] VIEWGAIN_EXPORT Suspicion suspect_masks(const Sensor& sensor,
                                                      std::span<const DepthFrame> unmasked,
                                                      std::span<const DepthFrame> masked,
                                                      std::span<const Pose> T_world_camera,
                                                      const BeliefGrid* map = nullptr);

}  // namespace viewgain
