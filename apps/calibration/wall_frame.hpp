// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// A Gaussian's standard deviation by its median amount.
inline constexpr double kSigmaByMedian = 1.4826;

/// The standard deviation of the median of n Gaussian values, times √n, by theirs.
inline constexpr double kMedianSigma = 1.2533;

/// The value in the middle, of an even count the mean of both; there is at least one.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// A plane that does not hold the camera's centre, camera frame: inverse_depth · p = 1 [1/m]. The
/// ray (x, y, 1) meets it at the depth 1 / (inverse_depth · ray), so that z⁻¹ is linear in x and y.
using InversePlane = Eigen::Vector3d;

/// Where the ray (x, y, 1) meets the plane, along the ray [m]; not positive: it does not.
[[nodiscard]] inline double range_to(const InversePlane& plane, const Eigen::Vector3d& ray) {
  return ray.norm() / plane.dot(ray);
}

/// The readings of a block of pixels as one.
struct WallBlock {
  Eigen::Vector3d ray;  ///< the mean one, (x, y, 1)
  double range = 0;     ///< the median reading, told at `ray` [m]
  double sigma = 0;     ///< standard deviation of that median, by the sensor's noise model [m]
  std::uint64_t readings = 0;
};

/// One frame of a wall, cut into blocks.
struct WallFrame {
  std::string name;
  InversePlane plane;          ///< that of the wall, or a first guess of it with the right distance
  bool tilt_is_known = false;  ///< else x and y of the plane are to be found
  std::vector<WallBlock> blocks;
  std::uint64_t border = 0, sparse = 0, limits = 0;  ///< readings that are in none
};

/// `wall` is where the wall is; without one, it crosses the optical axis at the depth `distance`
/// [m], and the frame says at which tilt. `rays` is the camera's ray_table(). Throws
/// Error(invalid_argument) that begins with the name for a frame without enough readings, that is
/// not flat, or that is elsewhere than it is said to be.
[[nodiscard]] WallFrame make_wall_frame(const Sensor& sensor,
                                        const std::vector<Eigen::Vector3d>& rays,
                                        const DepthFrame& frame,
                                        const std::optional<InversePlane>& wall, double distance,
                                        std::string name);

}  // namespace viewgain::detail
