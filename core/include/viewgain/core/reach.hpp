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

/// Region of camera poses that a robot can reach, world frame. A pose is reachable if it meets
/// every condition that is present. Its centre lies in one of the boxes, in one of the shells and
/// in all half-spaces, each including its faces. The pose is among `poses`, within the tolerance.
/// The predicate returns true. An empty region contains all poses.
struct VIEWGAIN_EXPORT ReachRegion {
  /// Space between two spheres with a common centre [m], world frame.
  struct Shell {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the spheres [m]
    double min_radius = 0;                             ///< [m]
    double max_radius = 0;                             ///< [m]
    bool operator==(const Shell&) const = default;
  };
  /// Points p of the world [m] with normal · p >= offset.
  struct HalfSpace {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< points inward, any length
    double offset = 0;  ///< normal · p on the plane [m for a unit normal]
    bool operator==(const HalfSpace&) const = default;
  };

  /// Tolerance for two camera poses to count as the same view.
  struct Tolerance {
    double distance = 0.010;                      ///< between the camera centres [m]
    double angle = 2.0 * std::numbers::pi / 180;  ///< angle of the rotation between them [rad]
    bool operator==(const Tolerance&) const = default;
  };

  std::vector<Box> boxes{};              ///< the centre lies in one of them, if any
  std::vector<Shell> shells{};           ///< likewise
  std::vector<HalfSpace> half_spaces{};  ///< the centre lies in all of them
  std::vector<Pose> poses{};             ///< T_world_camera
  Tolerance tolerance{};                 ///< tolerance for the poses
  std::function<bool(const Pose& T_world_camera)> predicate{};  ///< must be thread safe

  /// Throws Error(invalid_argument) naming the part for numbers that are not finite, boxes or
  /// shells that are inside out, and zero normals.
  void validate() const;

  /// Whether there is no limit at all.
  [[nodiscard]] bool is_everywhere() const;

  /// Whether the camera can reach the pose. Calls the predicate, if any, and rethrows its
  /// exceptions. Checks nothing. Cost: O(parts).
  [[nodiscard]] bool contains(const Pose& T_world_camera) const;
};

/// Whether `pose` is within the tolerance of one of `poses`, all T_world_camera. Checks nothing;
/// false for NaN. Cost: O(poses).
[[nodiscard]] VIEWGAIN_EXPORT bool is_among(const Pose& pose, std::span<const Pose> poses,
                                            const ReachRegion::Tolerance& tolerance = {});

}  // namespace viewgain
