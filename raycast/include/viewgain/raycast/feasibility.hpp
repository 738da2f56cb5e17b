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

/// Why a camera pose is not feasible. If several reasons apply, it is the first in this order.
enum class Infeasibility : std::uint8_t {
  none,
  bad_pose,     ///< the pose is not finite, or not rigid within 1e-3 (orthonormality_error())
  unreachable,  ///< the pose is outside the reachable region
  taken,        ///< a view was already taken at this pose
  plane,        ///< the body or the camera would touch or cross the support plane
  obstacle,     ///< the body or the camera would overlap a known obstacle
  collision,    ///< the body or the camera would overlap voxels that are not free
  too_near,     ///< too much of the image would show surface nearer than min_range
};
/// Name of the reason, as used in JSON. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view infeasibility_name(Infeasibility reason);

/// Settings of the feasibility check.
struct VIEWGAIN_EXPORT FeasibilityConfig {
  /// The housing of the sensor, a box. In the frame of the robot's flange, the box is centred on
  /// the z axis and extends from z = 0 to its depth. T_flange_camera is the pose of the camera in
  /// this frame. If it is unknown, the camera looks out of the middle of the front face.
  struct Body {
    /// Width, height and depth [m]. Default: those of the SR4000. Sensor::body_size has those of
    /// other sensors.
    std::array<double, 3> size{0.065, 0.065, 0.076};
    std::optional<Pose> T_flange_camera{};  ///< pose of the camera on the flange, if known
  };

  Body body{};                               ///< housing of the sensor
  double clearance = 0;                      ///< margin around the body on each side [m]
  ReachRegion reach{};                       ///< reachable camera poses
  ReachRegion::Tolerance taken_tolerance{};  ///< tolerance within which a pose counts as taken
  /// If given, views of this sensor are also checked for surface that is too near. A view is too
  /// near if, of the rays that end in the map, more than the fraction max_near_share end within
  /// min_range.
  std::optional<Sensor> sensor{};
  double max_near_share = 0.2;  ///< fraction of the rays that end in the map
};

/// Checks which camera poses are feasible in a scene. The body must not overlap voxels that are not
/// free, obstacles or the support plane. The pose must be within reach, and differ from the poses
/// of the views so far. Space outside the workspace counts as free. Obstacles that are boxes or
/// closed meshes are solid; open meshes are sheets. The body may touch them; overlaps below a
/// nanometre count as touching.
///
/// Cost: 0.5 to 1 µs per pose and thread. With FeasibilityConfig::sensor, poses with voxels within
/// min_range take 10 to 50 µs for an SR4000, and more for larger images.
///
/// Thread safety: all const members may run from many threads at once on one checker.
/// @code
/// const FeasibilityChecker checker(VoxelScene::build(grid), feasibility_of(sensor));
/// const FeasiblePoses possible = feasible_poses(checker, poses, grid.views());
/// @endcode
class VIEWGAIN_EXPORT FeasibilityChecker {
 public:
  /// `exec` sets the number of threads for batches. Throws Error(invalid_argument) for a null
  /// scene, a body without extent, a T_flange_camera that is not rigid, a negative clearance, a
  /// tolerance that is not finite, an invalid reach region, or an invalid number of threads
  /// (thread_count()). Cost: computes the rays of config.sensor and sorts the obstacles.
  FeasibilityChecker(std::shared_ptr<const VoxelScene> scene, const FeasibilityConfig& config,
                     const ExecConfig& exec = {});
  ~FeasibilityChecker();
  FeasibilityChecker(FeasibilityChecker&&) noexcept;
  FeasibilityChecker& operator=(FeasibilityChecker&&) noexcept;

  /// A checker with the same settings for another scene, for example of a growing map. This checker
  /// does not change. The new one shares its rays and threads. It also shares the obstacles if
  /// VoxelScene::update() made the new scene from the scene of this checker. Throws
  /// Error(invalid_argument) for a null scene. Cost: microseconds.
  [[nodiscard]] FeasibilityChecker with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// Checks a pose. `taken` has T_world_camera of the views so far. Rethrows exceptions of the
  /// reach region's predicate.
  [[nodiscard]] Infeasibility check(const Pose& T_world_camera,
                                    std::span<const Pose> taken = {}) const;

  /// Checks a batch of poses on all threads of the checker; result i is that of pose i. The threads
  /// call the reach region's predicate concurrently. If it throws, the batch ends and the exception
  /// is rethrown.
  [[nodiscard]] std::vector<Infeasibility> check(std::span<const Pose> T_world_camera,
                                                 std::span<const Pose> taken = {}) const;

  /// The scene of the checker.
  [[nodiscard]] const VoxelScene& scene() const noexcept;

 private:
  struct Impl;
  explicit FeasibilityChecker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Settings for a sensor: its body size, its T_flange_camera and FeasibilityConfig::sensor. If
/// Sensor::body_size is empty, the body is that of the SR4000. The reach is unlimited.
[[nodiscard]] VIEWGAIN_EXPORT FeasibilityConfig feasibility_of(const Sensor& sensor);

/// The feasible poses of a list of poses.
struct VIEWGAIN_EXPORT FeasiblePoses {
  std::vector<Pose> poses;                     ///< T_world_camera, in the order of the list
  std::vector<std::size_t> numbers;            ///< index of each of them in the list
  std::map<std::string, std::size_t> dropped;  ///< number of dropped poses per infeasibility_name()
};

/// Checks a list of poses T_world_camera. `taken` has T_world_camera of the views so far. Throws
/// and costs what FeasibilityChecker::check() does.
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses feasible_poses(const FeasibilityChecker& checker,
                                                           std::span<const Pose> poses,
                                                           std::span<const Pose> taken);

/// The poses of a list that are within reach, whatever the body. Rethrows exceptions of the
/// region's predicate. Cost: O(poses · conditions of the region).
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses reachable_poses(const ReachRegion& reach,
                                                            std::span<const Pose> poses);

}  // namespace viewgain
