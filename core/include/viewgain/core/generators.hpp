// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Candidate poses that need no surface. All look at `center` [m], world frame, image up = world up
/// (+z), +x at the poles. Deterministic; each throws Error(invalid_argument) for count 0, a radius
/// that is not positive and finite, a centre or an angle that is not finite, and Error(capacity)
/// for more than 100 million poses.

/// Fibonacci lattice on a sphere of `radius` [m]: z_i = 1 - (2i+1)/N,
/// azimuth_i = i pi (3 - sqrt 5).
[[nodiscard]] std::vector<Pose> sphere_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// The lattice's upper half, with N points: z_i = 1 - (2i+1)/(2N).
[[nodiscard]] std::vector<Pose> dome_poses(std::size_t count, double radius,
                                           const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle of latitude: eye = center + radius (cos e cos a, cos e sin a, sin e),
/// elevation e and azimuth a = start + i step [rad]; step defaults to 2 pi / count.
[[nodiscard]] std::vector<Pose> orbit_poses(
    std::size_t count, double radius, double elevation, double start = 0.0,
    std::optional<double> step = {}, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

}  // namespace viewgain
