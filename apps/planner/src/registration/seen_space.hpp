// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain::detail {

/// The space that a frame's readings bound, from the camera on, wherever within `sigmas` of its
/// prior the camera was: what of a map registration may need.
class SeenSpace {
 public:
  /// `rays` is the camera's table; `margin` [m]: so far beyond the readings, besides what the pose
  /// allows and 4 sigmas of noise.
  SeenSpace(const DepthFrame& frame, const Sensor& sensor, std::span<const Eigen::Vector3d> rays,
            const PosePrior& prior, double sigmas, double margin);

  /// May be called from many threads.
  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world) const;

 private:
  [[nodiscard]] int column_of(double x) const;
  [[nodiscard]] int row_of(double y) const;

  Eigen::Matrix3d R_camera_world_;
  Eigen::Vector3d center_;  // of the camera, world frame [m]
  // Tiles of x/z and y/z; of each how deep one looks there [m], 0: not at all.
  double tile_, low_x_, low_y_;
  int columns_, rows_;
  std::vector<double> depth_;
};

}  // namespace viewgain::detail
