// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/generators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kMaxPoses = 100'000'000;  // 9.6 GB

void check(const char* what, std::size_t count, double radius, const Eigen::Vector3d& center) {
  const std::string name(what);
  if (count == 0) throw Error(ErrorCode::invalid_argument, name + ": the number of poses is 0");
  if (count > kMaxPoses) {
    throw Error(ErrorCode::capacity, name + ": " + std::to_string(count) +
                                         " poses, the most possible is " +
                                         std::to_string(kMaxPoses));
  }
  if (!(std::isfinite(radius) && radius > 0)) {
    throw Error(ErrorCode::invalid_argument,
                name + ": the radius must be positive and finite, not " + std::to_string(radius));
  }
  if (!center.allFinite()) {
    throw Error(ErrorCode::invalid_argument, name + ": the centre is not finite");
  }
}

/// `count` lattice points whose z_i run from 1 downwards in steps of 2 / steps.
std::vector<Pose> lattice(std::size_t count, double steps, double radius,
                          const Eigen::Vector3d& center) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Pose> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double index = static_cast<double>(i);
    const double z = 1.0 - (2.0 * index + 1.0) / steps;
    const double ring = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double azimuth = index * golden_angle;
    const Eigen::Vector3d offset(ring * std::cos(azimuth), ring * std::sin(azimuth), z);
    poses.push_back(look_at(center + radius * offset, center));
  }
  return poses;
}

}  // namespace

std::vector<Pose> sphere_poses(std::size_t count, double radius, const Eigen::Vector3d& center) {
  check("sphere", count, radius, center);
  return lattice(count, static_cast<double>(count), radius, center);
}

std::vector<Pose> dome_poses(std::size_t count, double radius, const Eigen::Vector3d& center) {
  check("dome", count, radius, center);
  return lattice(count, 2.0 * static_cast<double>(count), radius, center);
}

std::vector<Pose> orbit_poses(std::size_t count, double radius, double elevation, double start,
                              std::optional<double> step, const Eigen::Vector3d& center) {
  check("orbit", count, radius, center);
  const double turn = step.value_or(2.0 * std::numbers::pi / static_cast<double>(count));
  if (!std::isfinite(elevation) || !std::isfinite(start) || !std::isfinite(turn)) {
    throw Error(ErrorCode::invalid_argument, "orbit: an angle is not finite");
  }
  std::vector<Pose> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = start + static_cast<double>(i) * turn;
    const Eigen::Vector3d offset(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    poses.push_back(look_at(center + radius * offset, center));
  }
  return poses;
}

}  // namespace viewgain
