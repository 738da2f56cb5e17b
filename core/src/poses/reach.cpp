// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/reach.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

[[noreturn]] void fail(const char* part, std::size_t index, const std::string& what) {
  refuse(std::string("reach: ") + part + " " + std::to_string(index) + " " + what);
}

/// Includes the faces, unlike Box::contains, because a camera may be exactly at the limit.
bool contains(const Box& box, const Eigen::Vector3d& p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = p[static_cast<Eigen::Index>(k)];
    if (!(value >= box.min[k] && value <= box.max[k])) return false;
  }
  return true;
}

bool contains(const ReachRegion::Shell& shell, const Eigen::Vector3d& p) {
  const double distance = (p - shell.center).norm();
  return distance >= shell.min_radius && distance <= shell.max_radius;
}

bool contains(const ReachRegion::HalfSpace& half_space, const Eigen::Vector3d& p) {
  return half_space.normal.dot(p) >= half_space.offset;
}

template <typename Part>
bool in_any(const std::vector<Part>& parts, const Eigen::Vector3d& p) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(),
                                      [&p](const Part& part) { return contains(part, p); });
}

// Angle of the rotation between two poses [rad]. An arc cosine would be inaccurate for small
// angles.
double angle_between(const Pose& a, const Pose& b) {
  const Eigen::Matrix3d R = a.rotation().transpose() * b.rotation();
  const Eigen::Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(twice_sine.norm(), R.trace() - 1.0);
}

}  // namespace

bool is_among(const Pose& pose, std::span<const Pose> poses,
              const ReachRegion::Tolerance& tolerance) {
  return std::any_of(poses.begin(), poses.end(), [&](const Pose& other) {
    return (pose.translation() - other.translation()).norm() <= tolerance.distance &&
           angle_between(pose, other) <= tolerance.angle;
  });
}

void ReachRegion::validate() const {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = boxes[i].min[k], high = boxes[i].max[k];
      if (!std::isfinite(low) || !std::isfinite(high)) fail("box", i, "is not finite");
      if (low > high) {
        fail("box", i,
             "is inside out: its minimum, " + short_text(low) + ", exceeds its maximum, " +
                 short_text(high));
      }
    }
  }
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const ReachRegion::Shell& shell = shells[i];
    if (!shell.center.allFinite() || !std::isfinite(shell.min_radius) ||
        !std::isfinite(shell.max_radius)) {
      fail("shell", i, "is not finite");
    }
    if (shell.min_radius < 0)
      fail("shell", i, "has the negative radius " + short_text(shell.min_radius));
    if (shell.min_radius > shell.max_radius) {
      fail("shell", i,
           "is inside out: its minimum radius, " + short_text(shell.min_radius) +
               ", exceeds its maximum radius, " + short_text(shell.max_radius));
    }
  }
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    const ReachRegion::HalfSpace& half_space = half_spaces[i];
    if (!half_space.normal.allFinite() || !std::isfinite(half_space.offset)) {
      fail("half-space", i, "is not finite");
    }
    if (half_space.normal.isZero(0)) fail("half-space", i, "has a normal with length 0");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!std::isfinite(orthonormality_error(poses[i]))) fail("pose", i, "is not a rigid transform");
  }
  for (const auto& [name, value, unit] : {std::tuple("distance", tolerance.distance, "m"),
                                          std::tuple("angle", tolerance.angle, "rad")}) {
    if (!(std::isfinite(value) && value >= 0)) {
      refuse(std::string("reach: the ") + name + " tolerance must be at least 0 and finite, not " +
             short_text(value) + " " + unit);
    }
  }
}

bool ReachRegion::is_everywhere() const {
  return boxes.empty() && shells.empty() && half_spaces.empty() && poses.empty() && !predicate;
}

bool ReachRegion::contains(const Pose& T_world_camera) const {
  const Eigen::Vector3d center = T_world_camera.translation();
  return in_any(boxes, center) && in_any(shells, center) &&
         std::all_of(half_spaces.begin(), half_spaces.end(),
                     [&center](const ReachRegion::HalfSpace& h) {
                       return viewgain::contains(h, center);
                     }) &&
         (poses.empty() || is_among(T_world_camera, poses, tolerance)) &&
         (!predicate || predicate(T_world_camera));
}

}  // namespace viewgain
