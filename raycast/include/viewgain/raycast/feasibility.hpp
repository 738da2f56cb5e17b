// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// Why a candidate is dropped; the first reason in this order.
enum class Infeasibility : std::uint8_t {
  none,
  bad_pose,     ///< not finite, or not rigid within 1e-3
  unreachable,  ///< outside the reachable region
  taken,        ///< a view was already taken there
  plane,        ///< the body or the camera would touch the support plane or be below it
  obstacle,     ///< the body or the camera would overlap a known obstacle
  collision,    ///< the body or the camera would overlap voxels that are not free
  too_near,     ///< much of the image would show surface nearer than min_range
};
/// Name as used in JSON; never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view infeasibility_name(Infeasibility reason);

/// Settings of the feasibility check: body, reach and sight.
struct VIEWGAIN_EXPORT FeasibilityConfig {
  /// The sensor's housing, a box. In the flange frame it is centred on the z axis and extends from
  /// z = 0 to its depth; T_flange_camera places the camera on the flange. Without a T_flange_camera
  /// the camera looks out of the middle of the box's front face.
  struct Body {
    /// Width, height, depth [m]; the SR4000's by default. Sensor::body_size has those of other
    /// sensors.
    std::array<double, 3> size{0.065, 0.065, 0.076};
    std::optional<Pose> T_flange_camera{};  ///< mounting on the flange, if known
  };

  Body body{};                               ///< the sensor's body
  double clearance = 0;                      ///< margin around the body on each side [m]
  ReachRegion reach{};                       ///< reachable camera poses
  ReachRegion::Tolerance taken_tolerance{};  ///< tolerance for two poses to be the same
  /// If given, rays are traced to find views that are too near. Only rays that end in the map
  /// count. A view is too near if more than max_near_share of these rays end within the sensor's
  /// min_range.
  std::optional<Sensor> sensor{};
  double max_near_share = 0.2;  ///< share of the rays that end in the map
};

/// Checks which camera poses are possible in a scene. The body must overlap neither voxels that are
/// not free, nor obstacles, nor the support plane. The pose must be within reach, and differ from
/// the views taken. Space outside the workspace counts as free. Boxes and closed meshes are solid;
/// an open mesh is a sheet. Overlaps below a nanometre count as touching.
///
/// Cost: 0.5-1 µs per pose and thread. With FeasibilityConfig::sensor, rays are traced if a voxel
/// is within min_range of the camera, and only until the result is certain. This takes 10-50 µs for
/// an SR4000, and more for larger images.
///
/// Thread safety: all const members may run from many threads at once on one checker.
/// @code
/// const FeasibilityChecker checker(VoxelScene::build(grid), feasibility_of(sensor));
/// const FeasiblePoses possible = feasible_poses(checker, poses, grid.views());
/// @endcode
class VIEWGAIN_EXPORT FeasibilityChecker {
 public:
  /// Removes the lens distortion of config.sensor and sorts the obstacles once. exec.num_threads
  /// applies to batches; the first batch starts the threads. Throws Error(invalid_argument) for a
  /// null scene, a body without extent or with a mounting that is not rigid, a negative clearance,
  /// a tolerance that is not finite, an invalid reach region, or an invalid number of threads
  /// (thread_count()).
  FeasibilityChecker(std::shared_ptr<const VoxelScene> scene, const FeasibilityConfig& config,
                     const ExecConfig& exec = {});
  ~FeasibilityChecker();
  FeasibilityChecker(FeasibilityChecker&&) noexcept;
  FeasibilityChecker& operator=(FeasibilityChecker&&) noexcept;

  /// Returns a checker with the same settings for another scene of a growing map; this checker does
  /// not change. The new checker shares rays and threads with this one. It also shares the
  /// obstacles if VoxelScene::update() made the new scene from this checker's scene. Cost:
  /// microseconds. Throws Error(invalid_argument) for a null scene.
  [[nodiscard]] FeasibilityChecker with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// Checks a pose. `taken`: T_world_camera of the views so far. Faces that only touch do not
  /// overlap. For an invalid pose the result is bad_pose. Rethrows exceptions of the reach
  /// region's predicate.
  [[nodiscard]] Infeasibility check(const Pose& T_world_camera,
                                    std::span<const Pose> taken = {}) const;

  /// Checks a batch of T_world_camera, result i for pose i, on all threads of the checker. The
  /// threads call the reach region's predicate concurrently; an exception ends the batch and is
  /// rethrown.
  [[nodiscard]] std::vector<Infeasibility> check(std::span<const Pose> T_world_camera,
                                                 std::span<const Pose> taken = {}) const;

  /// The scene of the checker.
  [[nodiscard]] const VoxelScene& scene() const noexcept;

 private:
  struct Impl;
  explicit FeasibilityChecker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Settings for a sensor: its body, its mounting and its min_range (FeasibilityConfig::sensor). If
/// Sensor::body_size is empty, the body is the SR4000's. The reach is unlimited.
[[nodiscard]] VIEWGAIN_EXPORT FeasibilityConfig feasibility_of(const Sensor& sensor);

/// The feasible poses of a list.
struct VIEWGAIN_EXPORT FeasiblePoses {
  std::vector<Pose> poses;                     ///< T_world_camera, in the order of the list
  std::vector<std::size_t> numbers;            ///< index of each in the list
  std::map<std::string, std::size_t> dropped;  ///< number of dropped poses per infeasibility_name()
};

/// Checks a list of T_world_camera. `taken`: views so far. Errors and cost: see
/// FeasibilityChecker::check().
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses feasible_poses(const FeasibilityChecker& checker,
                                                           std::span<const Pose> poses,
                                                           std::span<const Pose> taken);

/// The poses within the reach, in order, regardless of the body. Rethrows exceptions of the
/// region's predicate. Cost: O(poses · parts).
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses reachable_poses(const ReachRegion& reach,
                                                            std::span<const Pose> poses);

}  // namespace viewgain
