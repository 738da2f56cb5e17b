// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

/// @file
/// Candidate poses that need no surface, T_world_camera, in the order of their index i. All but
/// rings look at `center` [m], world frame, image up = world up (+z), +x at the poles.
/// Deterministic. Each of the functions throws Error(invalid_argument) for count 0, a `radius` [m]
/// that is not positive and finite, a centre or an angle [rad] that is not finite, and
/// Error(capacity) for more than 100 million poses. Cost: O(count).

namespace viewgain {

/// Fibonacci lattice on a sphere of `radius` [m]: z_i = 1 - (2i+1)/N,
/// azimuth_i = i pi (3 - sqrt 5).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> sphere_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// The lattice's upper half, with N points: z_i = 1 - (2i+1)/(2N).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> dome_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle of latitude: eye = center + radius (cos e cos a, cos e sin a, sin e),
/// elevation e [rad] and azimuth a = start + i step [rad]; step defaults to 2 pi / count.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> orbit_poses(
    std::size_t count, double radius, double elevation, double start = 0.0,
    std::optional<double> step = {}, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle round the vertical axis: eye = center + (radius cos a, radius sin a, height),
/// azimuth a = start + 2 pi i / count [rad], looking down by `tilt` [rad] towards the axis; height
/// and radius [m], radius > 0.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> ring_poses(
    std::size_t count, double radius, double height, double tilt, double start = 0.0,
    const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// The view sets of Isler et al. 2016 (ig_active_reconstruction), scaled so that their radius of
/// 0.5 m (48: 0.6 m) becomes `radius`; heights are above `center`. Rings of 16 azimuths on a
/// cylinder, level, and on the dome that closes it at its highest ring, looking at the dome's
/// centre. total 48: heights 0.15 and 0.35 m, dome ring 45° up; 80: heights 0.15, 0.30, 0.45 m,
/// dome rings 30° and 60° up; 288: heights 0.1, 0.2, 0.3, 0.4 m, dome rings 30° and 60° up, each
/// ring also tilted by 22.5° up and down; 864: that with cylinders and domes of 0.8, 1.2 and 1.6
/// times the radius at the same heights. Throws Error(invalid_argument) for another total.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> literature_ring_poses(
    std::size_t total, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Uniform in the volume between two spheres, looking at the centre; the same poses for the same
/// seed on every machine, more of them if more are asked for. 0 < min_radius <= max_radius [m].
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> shell_poses(
    std::size_t count, double min_radius, double max_radius, std::uint64_t seed,
    const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

}  // namespace viewgain
