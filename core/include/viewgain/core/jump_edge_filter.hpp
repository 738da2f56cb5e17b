// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numbers>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// Removes flying pixels: readings (measured depths) that mix two surfaces at a depth
/// discontinuity. The method is that of May et al. ("Three-dimensional mapping with time-of-flight
/// cameras", J. Field Robotics 26, 2009). A reading p is removed if one of its 8 neighbours, q, is
/// nearer to the camera, and the angle between p's ray and the line from p to q is below a
/// threshold. All comparisons use the unfiltered depths. Thread safety: const members may run from
/// many threads.
class VIEWGAIN_EXPORT JumpEdgeFilter {
 public:
  /// Defines which pixels count as flying.
  struct Config {
    double angle = 5.0 * std::numbers::pi / 180;  ///< threshold [rad]; allowed: 1° to 10°
    bool two_sided = false;  ///< also compare with farther neighbours, as published
  };

  /// Computes the ray of each pixel once. Throws Error(invalid_argument) for an invalid camera or
  /// an angle outside its bounds.
  JumpEdgeFilter(const PinholeCamera& camera, const Config& config);
  /// Uses the default configuration.
  explicit JumpEdgeFilter(const PinholeCamera& camera) : JumpEdgeFilter(camera, Config{}) {}

  /// Sets the depth of flying pixels to DepthFrame::kInvalid and their amplitude to 0. Returns
  /// their number. Throws Error(invalid_argument) if frame and camera differ in size. Cost: one
  /// pass over the pixels and their 8 neighbours.
  std::size_t apply(DepthFrame& frame) const;

 private:
  PinholeCamera camera_;
  Config config_;
  std::vector<Eigen::Vector3d> rays_;
  /// Neighbouring ranges are continuous if the ratio of their squares is below this.
  double smooth_ = 1;
};

}  // namespace viewgain
