// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Region of camera poses that a robot can reach, in the world frame. Each member that is not empty
/// is a condition, and a reachable pose meets all of them:
/// - The camera centre lies in or on one of the boxes.
/// - The camera centre lies in or on one of the shells.
/// - The camera centre lies in or on all half-spaces.
/// - The pose is one of `poses`, within the tolerance.
/// - The predicate returns true.
struct VIEWGAIN_EXPORT ReachRegion {
  /// Space between two spheres with a common centre, world frame.
  struct Shell {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< centre of both spheres [m]
    double min_radius = 0;                             ///< [m]
    double max_radius = 0;                             ///< [m]
    bool operator==(const Shell&) const = default;
  };
  /// All points p in the world frame [m] with normal · p >= offset.
  struct HalfSpace {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< points into the half-space; any length
    double offset = 0;  ///< value of normal · p on the plane [m, if normal is a unit vector]
    bool operator==(const HalfSpace&) const = default;
  };

  /// Tolerance for two camera poses to count as the same view.
  struct Tolerance {
    double distance = 0.010;  ///< largest distance between the camera centres [m]
    double angle = 2.0 * std::numbers::pi / 180;  ///< largest angle between the orientations [rad]
    bool operator==(const Tolerance&) const = default;
  };

  std::vector<Box> boxes{};              ///< the camera centre lies in one of them
  std::vector<Shell> shells{};           ///< the camera centre lies in one of them
  std::vector<HalfSpace> half_spaces{};  ///< the camera centre lies in all of them
  std::vector<Pose> poses{};             ///< the pose is one of these T_world_camera
  Tolerance tolerance{};                 ///< tolerance for `poses`
  std::function<bool(const Pose& T_world_camera)> predicate{};  ///< must be thread safe

  /// Throws Error(invalid_argument), naming the member, if a number is not finite, a minimum
  /// exceeds its maximum, or a normal is zero.
  void validate() const;

  /// Whether the region is unlimited, because all members are empty.
  [[nodiscard]] bool is_everywhere() const;

  /// Whether the camera can reach the pose. Calls the predicate, if any, and rethrows its
  /// exceptions. The pose is not checked. Cost: linear in the number of conditions.
  [[nodiscard]] bool contains(const Pose& T_world_camera) const;
};

/// Whether `pose` is within the tolerance of one of `poses`. All are T_world_camera and are not
/// checked. False for NaN. Cost: O(poses).
[[nodiscard]] VIEWGAIN_EXPORT bool is_among(const Pose& pose, std::span<const Pose> poses,
                                            const ReachRegion::Tolerance& tolerance = {});

}  // namespace viewgain
