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
/// Generators of candidate poses (T_world_camera) that need no map. Pose i is the i-th of the
/// result. `count` is the number of poses, called N in equations. `center` [m] is in the world
/// frame. All poses except those of rings look at `center`. The image's up direction is world up
/// (+z), or +x at the poles. Deterministic. Cost: O(count).
///
/// All functions throw Error(invalid_argument) if count is 0, a `radius` [m] is not positive and
/// finite, or a centre or an angle [rad] is not finite. They throw Error(capacity) above 100
/// million poses.

namespace viewgain {

/// Fibonacci lattice on a sphere of `radius` [m]: z_i = 1 - (2i+1)/N,
/// azimuth_i = i pi (3 - sqrt 5).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> sphere_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Fibonacci lattice on the upper half of a sphere: z_i = 1 - (2i+1)/(2N).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> dome_poses(
    std::size_t count, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle of latitude. The camera centres are center + radius (cos e cos a, cos e sin a,
/// sin e), with elevation e [rad] and azimuth a = start + i step [rad]. Default of `step`: 2 pi /
/// count.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> orbit_poses(
    std::size_t count, double radius, double elevation, double start = 0.0,
    std::optional<double> step = {}, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Views on a circle around the vertical axis through `center`. The camera centres are center +
/// (radius cos a, radius sin a, height), with azimuth a = start + 2 pi i / count [rad]. The cameras
/// look towards the axis, `tilt` [rad] below the horizontal. Height and radius are in metres.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> ring_poses(
    std::size_t count, double radius, double height, double tilt, double start = 0.0,
    const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// View sets of Isler et al. 2016 (ig_active_reconstruction). A set consists of rings of 16 views
/// each. Some rings lie on a vertical cylinder around `center` and look horizontally at its axis.
/// The others lie on a dome of the same radius above the highest of these rings, and look at the
/// dome's centre. A set is scaled so that its radius of 0.5 m (0.6 m for 48 poses) becomes
/// `radius`. `total` selects the set. The list states the unscaled heights of the cylinder's rings
/// above `center`, and the elevations of the dome's rings:
/// - 48: 0.15 and 0.35 m; dome 45°.
/// - 80: 0.15, 0.30 and 0.45 m; dome 30° and 60°.
/// - 288: 0.1, 0.2, 0.3 and 0.4 m; dome 30° and 60°; each ring three times, with tilts of 0°,
///   -22.5° and +22.5°.
/// - 864: the set of 288 three times, with 0.8, 1.2 and 1.6 times the radius, at the same heights.
///
/// Throws Error(invalid_argument) for any other total.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> literature_ring_poses(
    std::size_t total, double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

/// Random camera centres, uniformly distributed in the volume between two spheres. Requires 0 <
/// min_radius <= max_radius [m]. The same seed gives the same poses on every machine, and a larger
/// count appends poses.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> shell_poses(
    std::size_t count, double min_radius, double max_radius, std::uint64_t seed,
    const Eigen::Vector3d& center = Eigen::Vector3d::Zero());

}  // namespace viewgain
