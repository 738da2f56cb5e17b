// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain::detail {

/// A reading with the surface round it, camera frame.
struct Reading {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit, toward the camera
  MeasurementSigmas sigmas;
  double rim = 0;  ///< of smoothed ones: lateral sigmas, times how many of 25 lie past a rim [m]
  double extrapolation = 1;  ///< of smoothed ones: their variance over that of a full window
  int u = 0, v = 0;          ///< its pixel
  int level = 0;  ///< from this one on it takes part: 0 for each 4th of a row, 1 each 2nd, 2 all
};

inline constexpr int kLevels = 3;

/// The readings of a frame on a lattice of pixels with about `max_readings` of them, row by row.
/// The normal is that of the plane through 5x5 readings within `radius` [m]; a reading without one,
/// at the rim of what is seen, is left out, and so is what is known (DepthFrame::known_depth).
/// Not smoothed, its point is as it was read. Smoothed, it is that of the plane through the 5x5
/// pixels round it, with a fifth of the noise; where some of these have no reading it is less
/// exact. `rays` is the camera's table.
[[nodiscard]] std::vector<Reading> readings_of(const DepthFrame& frame, const Sensor& sensor,
                                               std::span<const Eigen::Vector3d> rays, double radius,
                                               bool are_smoothed, std::size_t max_readings,
                                               ThreadPool& pool);

}  // namespace viewgain::detail
