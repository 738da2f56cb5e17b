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
/// Generators of candidate poses that need no map. They return T_world_camera, ordered by index i.
/// All except the rings look at `center` [m] in the world frame, with the image up along world up
/// (+z), or +x at the poles. Deterministic. Cost: O(count).
///
/// All functions throw Error(invalid_argument) for count 0, a `radius` [m] that is not positive and
/// finite, and a centre or an angle [rad] that is not finite. They throw Error(capacity) above 100
/// million poses.

namespace viewgain {

/// Fibonacci lattice on a sphere of `radius` [m]: z_i = 1 - (2i+1)/N,
/// azimuth_i = i pi (3 - sqrt 5).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> sphere_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Upper half of the Fibonacci lattice, with N points: z_i = 1 - (2i+1)/(2N).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> dome_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle of latitude: eye = center + radius (cos e cos a, cos e sin a, sin e), with
/// elevation e [rad] and azimuth a = start + i step [rad]; step defaults to 2 pi / count.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> orbit_poses(
    std::size_t count, double radius, double elevation, double start = 0.0,
    std::optional<double> step = {}, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle around the vertical axis: eye = center + (radius cos a, radius sin a, height),
/// azimuth a = start + 2 pi i / count [rad], looking towards the axis, down by `tilt` [rad]. Height
/// and radius in metres, radius > 0.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> ring_poses(
    std::size_t count, double radius, double height, double tilt, double start = 0.0,
    const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// View sets of Isler et al. 2016 (ig_active_reconstruction), scaled so that their radius of 0.5 m
/// (48 poses: 0.6 m) becomes `radius`. Each ring has 16 azimuths. Rings on a cylinder look
/// horizontally. Rings on a dome above the highest of them look at the dome's centre. `total`
/// selects the heights of the rings above `center` and the elevations of the dome's rings:
/// - 48: 0.15 and 0.35 m; dome 45°.
/// - 80: 0.15, 0.30 and 0.45 m; dome 30° and 60°.
/// - 288: 0.1, 0.2, 0.3 and 0.4 m; dome 30° and 60°; each ring also tilted by ±22.5°.
/// - 864: the set of 288 with 0.8, 1.2 and 1.6 times the radius, at the same heights.
///
/// Throws Error(invalid_argument) for another total.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> literature_ring_poses(
    std::size_t total, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Uniformly random in the volume between two spheres, looking at the centre; 0 < min_radius <=
/// max_radius [m]. A seed gives the same poses on every machine; a larger count appends poses.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> shell_poses(
    std::size_t count, double min_radius, double max_radius, std::uint64_t seed,
    const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

}  // namespace viewgain
