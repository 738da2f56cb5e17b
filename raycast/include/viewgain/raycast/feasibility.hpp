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

/// Why a candidate is dropped; checked in this order, the first one counts.
enum class Infeasibility : std::uint8_t {
  none,
  bad_pose,     ///< not finite, or off by more than 1e-3
  unreachable,  ///< outside the reachable region
  taken,        ///< a view was taken there already
  plane,        ///< the body or the camera would touch the support plane or be under it
  obstacle,     ///< the body would overlap a known obstacle, or the camera be in one
  collision,    ///< the body would overlap voxels that are not free, or the camera be in one
  too_near,     ///< much of the image would show what is nearer than the sensor can measure
};
/// Its name, as JSON has it; never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view infeasibility_name(Infeasibility reason);

/// What must have room, and where the robot gets.
struct VIEWGAIN_EXPORT FeasibilityConfig {
  /// The sensor's housing, a box. In the flange's frame it is centred on the z axis and reaches
  /// from z = 0 to its depth; T_flange_camera places the camera on the flange. Without one the
  /// camera's centre is the middle of the box's front face, looking out of it.
  struct Body {
    /// Width, height, depth [m]; the SR4000's. Sensor::body_size has another sensor's.
    std::array<double, 3> size{0.065, 0.065, 0.076};
    std::optional<Pose> T_flange_camera{};  ///< mounting on the flange, if known
  };

  Body body{};                               ///< what must have room
  double clearance = 0;                      ///< the body is grown by this on each side [m]
  ReachRegion reach{};                       ///< where the camera may be
  ReachRegion::Tolerance taken_tolerance{};  ///< when two poses are the same
  /// Where given: a view is too near if more than max_near_share of its rays that end in the map
  /// end within the sensor's min_range, where it measures nothing.
  std::optional<Sensor> sensor{};
  double max_near_share = 0.2;  ///< of the rays that end in the map
};

/// Says which camera poses are possible in a scene: body against its voxels that are not free and
/// its surroundings; reach; views taken. Outside the workspace nothing is known to block. Obstacle
/// boxes and closed meshes are solid, an open mesh is a sheet; overlaps of less than a nanometre
/// are touching.
///
/// Costs 0.5-1 µs per pose and thread, with two obstacles as well. With a sensor it stays under 1
/// µs where no voxel is within min_range; else rays are traced until the answer is clear, which
/// takes 10-50 µs for the 400 rays of an SR4000 and as much more as another sensor has more pixels.
///
/// Thread safety: all const members may run from many threads at once on one checker.
/// @code
/// const FeasibilityChecker checker(VoxelScene::build(grid), feasibility_of(sensor));
/// const FeasiblePoses possible = feasible_poses(checker, poses, grid.views());
/// @endcode
class VIEWGAIN_EXPORT FeasibilityChecker {
 public:
  /// Undoes the lens distortion of config.sensor and sorts the obstacles once. exec.num_threads is
  /// for batches; their threads start with the first one. Throws Error(invalid_argument) for a null
  /// scene, a body without extent or with a mounting that is no rigid transform, a negative
  /// clearance, a tolerance that is not finite, a reach region that is not valid, or a number of
  /// threads that thread_count() refuses.
  FeasibilityChecker(std::shared_ptr<const VoxelScene> scene, const FeasibilityConfig& config,
                     const ExecConfig& exec = {});
  ~FeasibilityChecker();
  FeasibilityChecker(FeasibilityChecker&&) noexcept;
  FeasibilityChecker& operator=(FeasibilityChecker&&) noexcept;

  /// The same checker of another scene, for a map that grows. The lens, the threads and, if the
  /// scene was made by VoxelScene::update from this one's, the obstacles are shared with this
  /// checker, which stays as it is. What is left is a look at the scene's list of regions (cubes of
  /// 32³ voxels) and of tiles larger than that: a microsecond for 6,000 leaves. Throws
  /// Error(invalid_argument) for a null scene.
  [[nodiscard]] FeasibilityChecker with_scene(std::shared_ptr<const VoxelScene> scene) const;

  /// `taken`: T_world_camera of the views so far, in any order. Touching faces do not overlap. What
  /// the reach region's predicate throws passes through; a bad pose is one of the answers.
  [[nodiscard]] Infeasibility check(const Pose& T_world_camera,
                                    std::span<const Pose> taken = {}) const;

  /// The answers for a batch of T_world_camera, result i for pose i, on all threads of the checker,
  /// which call the reach region's predicate at once. What that throws ends the batch and is thrown
  /// again here.
  [[nodiscard]] std::vector<Infeasibility> check(std::span<const Pose> T_world_camera,
                                                 std::span<const Pose> taken = {}) const;

  /// The scene that poses are held against.
  [[nodiscard]] const VoxelScene& scene() const noexcept;

 private:
  struct Impl;
  explicit FeasibilityChecker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Settings for a sensor: its body, its mounting and its min_range (see FeasibilityConfig::sensor).
/// Without Sensor::body_size the body is the SR4000's. The reach is not limited.
[[nodiscard]] VIEWGAIN_EXPORT FeasibilityConfig feasibility_of(const Sensor& sensor);

/// The feasible poses of a list.
struct VIEWGAIN_EXPORT FeasiblePoses {
  std::vector<Pose> poses;                     ///< T_world_camera, in the order of the list
  std::vector<std::size_t> numbers;            ///< index of each in the list
  std::map<std::string, std::size_t> dropped;  ///< infeasibility_name() -> number of poses
};

/// Checks a list of T_world_camera. `taken`: views so far, in any order. Throws and costs as
/// FeasibilityChecker::check().
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses feasible_poses(const FeasibilityChecker& checker,
                                                           std::span<const Pose> poses,
                                                           std::span<const Pose> taken);

/// The poses in reach, in their order, whatever the body meets there. What the region's predicate
/// throws passes through. Costs O(poses · parts).
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses reachable_poses(const ReachRegion& reach,
                                                            std::span<const Pose> poses);

}  // namespace viewgain
