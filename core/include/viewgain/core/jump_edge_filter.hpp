// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

class ThreadPool;

/// Removes flying pixels: readings (measured depths) that mix two surfaces at a depth
/// discontinuity. The method is that of May et al. ("Three-dimensional mapping with time-of-flight
/// cameras", J. Field Robotics 26, 2009). A reading p is removed if one of its 8 neighbours, q, is
/// nearer to the camera, and the angle between p's ray and the line from p to q is below a
/// threshold. All comparisons use the unfiltered depths. Thread safety: const members may run from
/// many threads. Copies share their threads.
class VIEWGAIN_EXPORT JumpEdgeFilter {
 public:
  /// Defines which pixels count as flying.
  struct Config {
    double angle = 5.0 * std::numbers::pi / 180;  ///< threshold [rad]; allowed: 1° to 10°
    bool two_sided = false;  ///< also compare with farther neighbours, as published
  };

  /// Computes the ray of each pixel once, and starts threads. Throws Error(invalid_argument) for an
  /// invalid camera or an angle outside its bounds, and whatever thread_count() throws.
  JumpEdgeFilter(const PinholeCamera& camera, const Config& config, const ExecConfig& exec = {});
  /// Uses the default configuration.
  explicit JumpEdgeFilter(const PinholeCamera& camera) : JumpEdgeFilter(camera, Config{}) {}

  /// Sets the depth of flying pixels to DepthFrame::kInvalid and their amplitude to 0. Returns
  /// their number. Throws Error(invalid_argument) if frame and camera differ in size. Cost: two
  /// passes over the pixels and their 8 neighbours, and 5 bytes per pixel.
  std::size_t apply(DepthFrame& frame) const;

 private:
  struct Image;  ///< the unfiltered depths and their ranges
  [[nodiscard]] bool is_flying(const Image& image, std::size_t u, std::size_t v) const;
  /// Sets 1 for the flying pixels of some rows.
  void find(const Image& image, std::size_t begin, std::size_t end,
            std::vector<std::uint8_t>& flying) const;
  PinholeCamera camera_;
  Config config_;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays_;
  /// Of the rays, divided by the largest, so that ranges are at most depths; infinite for pixels
  /// without a ray.
  std::vector<float> norms_;
  /// A pixel and a neighbour are continuous if the ratio of their ranges is below the pixel's.
  std::vector<float> smooth_;
  std::shared_ptr<ThreadPool> pool_;
};

}  // namespace viewgain
