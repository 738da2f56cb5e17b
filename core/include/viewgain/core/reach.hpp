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

/// Where a robot can put the camera. World frame. A camera pose is reachable if its centre lies in
/// at least one of the boxes (where there are any), in at least one of the shells (where there are
/// any) and in every half-space, limits included; if it is among the poses (where there are any);
/// and if the predicate, where there is one, says so. Empty: everything is reachable.
struct VIEWGAIN_EXPORT ReachRegion {
  /// Between two spheres round a centre [m], world frame.
  struct Shell {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the spheres [m]
    double min_radius = 0;                             ///< [m]
    double max_radius = 0;                             ///< [m]
    bool operator==(const Shell&) const = default;
  };
  /// The points p of the world [m] with normal · p >= offset.
  struct HalfSpace {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< points inward; need not be unit
    double offset = 0;  ///< normal · p of the plane, in the unit of both [m]
    bool operator==(const HalfSpace&) const = default;
  };

  /// When two camera poses count as the same view.
  struct Tolerance {
    double distance = 0.010;                      ///< between the camera centres [m]
    double angle = 2.0 * std::numbers::pi / 180;  ///< of the rotation between them [rad]
    bool operator==(const Tolerance&) const = default;
  };

  std::vector<Box> boxes{};     ///< the centre lies in one of them, if there are any; in any order
  std::vector<Shell> shells{};  ///< likewise, in any order
  std::vector<HalfSpace> half_spaces{};  ///< the centre lies in all of them, in any order
  std::vector<Pose> poses{};             ///< T_world_camera, in any order
  Tolerance tolerance{};                 ///< of the poses
  std::function<bool(const Pose& T_world_camera)> predicate{};  ///< must be thread safe

  /// Throws Error(invalid_argument) naming the part for numbers that are not finite, boxes or
  /// shells inside out, a zero normal.
  void validate() const;

  /// Is there no limit at all?
  [[nodiscard]] bool is_everywhere() const;

  /// May the camera be there? Calls the predicate, if there is one; what it throws passes through.
  /// Checks nothing. Costs O(parts).
  [[nodiscard]] bool contains(const Pose& T_world_camera) const;
};

/// True if `pose` is within the tolerance of one of `poses`, all T_world_camera, in any order.
/// Checks nothing: NaN is near nothing. Costs O(poses).
[[nodiscard]] VIEWGAIN_EXPORT bool is_among(const Pose& pose, std::span<const Pose> poses,
                                            const ReachRegion::Tolerance& tolerance = {});

}  // namespace viewgain
