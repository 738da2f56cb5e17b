// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// Depth image along the optical axis (z, not range) [m], row-major. A pixel is a reading (a
/// measured depth, 0 < z < infinity), kInvalid or kOutOfRange. A value type.
struct VIEWGAIN_EXPORT DepthFrame {
  static constexpr float kInvalid = 0.0F;  ///< depth [m] of a pixel without information
  /// Depth [m] of a pixel whose ray meets nothing up to max_range.
  static constexpr float kOutOfRange = std::numeric_limits<float>::infinity();
  /// Amplitude [m⁻²] of a saturated pixel, whose true amplitude is unknown.
  static constexpr float kSaturated = std::numeric_limits<float>::infinity();

  int width = 0;             ///< [px]
  int height = 0;            ///< [px]
  std::vector<float> depth;  ///< width * height values
  /// Empty, or width * height values: the signal cosθ / t² [m⁻²] that a diffuse surface returns,
  /// where θ is the angle of incidence and t the range. The surface has the brightness that the
  /// noise model assumes. For kSaturated, θ is computed from the depths.
  std::vector<float> amplitude{};
  /// Empty, or width * height values [m]. A reading at or beyond this depth shows a known object
  /// that is not part of the map, such as the wall of a bin. It marks free space, but no surface.
  /// Infinity: no known object. ObstacleView sets these depths.
  std::vector<float> known_depth{};
  /// Identifies the frame, or empty. frame_identity() of viewgain::formats makes it from a hash of
  /// the frame's bytes (16 hexadecimal digits), a space and a name. A map stores the identities of
  /// its frames (MapNotes).
  std::string identity{};

  /// Whether this pixel's reading shows a known object. The row-major index is unchecked.
  [[nodiscard]] bool shows_known(std::size_t pixel) const {
    return !known_depth.empty() && depth[pixel] >= known_depth[pixel];
  }

  /// Depth [m] of pixel (u, v): column and row, both from 0 and unchecked.
  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)];
  }
  /// Whether the images are equal. Ignores the identity.
  bool operator==(const DepthFrame& other) const {
    return width == other.width && height == other.height && depth == other.depth &&
           amplitude == other.amplitude && known_depth == other.known_depth;
  }
};

/// Throws Error(invalid_argument) with both sizes unless the frame, its amplitudes and its known
/// depths (if any) have the camera's size. Constant time.
VIEWGAIN_EXPORT void check_frame_size(const DepthFrame& frame, const PinholeCamera& camera);

}  // namespace viewgain
