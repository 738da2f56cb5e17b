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

/// Removes flying pixels, the mixtures of two surfaces at a jump of depth (after May et al.,
/// "Three-dimensional mapping with time-of-flight cameras", J. Field Robotics 26, 2009). A reading
/// p goes when, for one of its 8 neighbours q that is a reading nearer to the camera, the angle
/// between p's viewing ray and the edge from p to q is under the threshold. All pixels are judged
/// by the frame as it came. Thread safety: const members may run from many threads.
class VIEWGAIN_EXPORT JumpEdgeFilter {
 public:
  /// Which pixels count as flying.
  struct Config {
    double angle = 5.0 * std::numbers::pi / 180;  ///< threshold, in 1°..10° [rad]
    bool two_sided = false;  ///< the literal form: nearer and farther neighbours alike
  };

  /// Undoes the lens distortion once. Throws Error(invalid_argument) for a camera that is not valid
  /// or an angle outside its bounds.
  JumpEdgeFilter(const PinholeCamera& camera, const Config& config);
  /// By the default configuration.
  explicit JumpEdgeFilter(const PinholeCamera& camera) : JumpEdgeFilter(camera, Config{}) {}

  /// Turns flying pixels into DepthFrame::kInvalid (their amplitude 0); returns how many. Throws
  /// Error(invalid_argument) if the frame's size is not the camera's. Cost: a pass over the pixels
  /// and the 8 neighbours of each.
  std::size_t apply(DepthFrame& frame) const;

 private:
  PinholeCamera camera_;
  Config config_;
  std::vector<Eigen::Vector3d> rays_;
  double smooth_ = 1;  ///< squared ranges of neighbours whose ratio is below this are no jump
};

}  // namespace viewgain
