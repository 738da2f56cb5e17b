// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <random>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::test {

/// How far along a ray is the box of these half sides round the origin? In lengths of the ray;
/// where it enters, infinity if it does not, or from `inside` where it leaves.
[[nodiscard]] double range_to_box(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray,
                                  const Eigen::Vector3d& half, bool inside);

/// A camera whose readings scatter by `noise` along the ray and across it [m].
[[nodiscard]] Sensor box_camera(double noise);

/// What such a camera sees of a closed box in a room, a cube of 1.2 m. A pixel whose 3 x 3 parts
/// see both reports something between.
[[nodiscard]] DepthFrame see_box(const Sensor& sensor, const Pose& T_world_camera,
                                 const Eigen::Vector3d& half, std::mt19937_64& random);

}  // namespace viewgain::test
