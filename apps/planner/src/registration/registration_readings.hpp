// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A reading with the surface round it, camera frame; or a point of a map's surface.
struct Reading {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit, toward the camera
  double variance = 0;     ///< along the normal, as pairs count it [m²]
  double axial = 0;        ///< 1 sigma along the ray [m]
  double rim = 0;          ///< lateral sigmas, times how many of 25 pixels lie past a rim [m]
  int u = 0, v = 0;        ///< its pixel
  int level = 0;  ///< from this one on it takes part: 0 each 4th of a row, 1 each 2nd, 2 all
  std::uint32_t part = 0;  ///< of a map: neighbours, whose errors are alike, have the same
};

inline constexpr int kLevels = 3;

struct FrameReadings {
  std::vector<Reading> all;  ///< row by row
  int stride = 1;            ///< of the lattice of pixels that they are at
};

/// The readings of a frame on a lattice of pixels with about `max_readings` of them. The normal is
/// that of the plane through 5x5 readings within `radius` [m]; a reading without one, at the rim of
/// what is seen, is left out, and so is what is known (DepthFrame::known_depth). A smoothed point
/// is that of the plane through the 5x5 pixels round it, with a fifth of the noise; where some of
/// these have no reading it is less exact. `rays` is the camera's table.
[[nodiscard]] FrameReadings readings_of(const DepthFrame& frame, const Sensor& sensor,
                                        std::span<const Eigen::Vector3d> rays, double radius,
                                        bool are_smoothed, std::size_t max_readings,
                                        ThreadPool& pool);

}  // namespace viewgain::detail
