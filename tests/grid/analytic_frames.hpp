// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::test {

/// A sphere seen from outside, or from inside (a room).
struct Sphere {
  Eigen::Vector3d center;  ///< [m], world
  double radius = 0;       ///< [m]
};

/// What a noise-free sensor sees of the spheres: the nearest surface in front of it; kOutOfRange
/// where there is none.
[[nodiscard]] DepthFrame see_spheres(const Sensor& sensor, const Pose& T_world_camera,
                                     const std::vector<Sphere>& spheres);

/// The plane z = z0 + slope x of the world, seen along +z from the origin.
[[nodiscard]] DepthFrame see_plane(const Sensor& sensor, double z0, double slope = 0);

/// An object about as large as the camel, of three spheres, in a room of 1.5 m radius.
[[nodiscard]] std::vector<Sphere> three_spheres_in_a_room();

/// The workspace [-0.2, 0.2]³ m with N³ voxels.
[[nodiscard]] GridConfig object_grid(int n);

/// View i on a ring of 0.6 m around the origin, 27° up, 46° apart.
[[nodiscard]] Pose ring_view(int i);

/// A small camera with the image of width x height pixels and focal lengths of about one width.
[[nodiscard]] Sensor small_sensor(int width, int height);

}  // namespace viewgain::test
