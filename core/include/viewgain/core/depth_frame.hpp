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

/// Depth image, row-major. Depths [m] are measured along the optical axis (z); a range is measured
/// along the ray. Each pixel holds a reading (a measured depth, 0 < z < infinity), kInvalid or
/// kOutOfRange. A value type.
struct VIEWGAIN_EXPORT DepthFrame {
  static constexpr float kInvalid = 0.0F;  ///< depth [m] of a pixel that measured nothing
  /// Depth [m] of a pixel whose ray meets nothing up to Sensor::max_range.
  static constexpr float kOutOfRange = std::numeric_limits<float>::infinity();
  /// Amplitude [m⁻²] of a saturated pixel, whose true amplitude is unknown.
  static constexpr float kSaturated = std::numeric_limits<float>::infinity();

  int width = 0;             ///< [px]
  int height = 0;            ///< [px]
  std::vector<float> depth;  ///< width * height values
  /// Empty, or width * height values: the signal cosθ / t² [m⁻²] of a diffuse surface with the
  /// reflectance that the noise model assumes. θ is the angle of incidence and t the range. Where
  /// the value is kSaturated, θ is computed from neighbouring depths.
  std::vector<float> amplitude{};
  /// Empty, or width * height depths [m], which ObstacleView sets. A reading at or beyond this
  /// depth shows a known object that is not part of the map, such as the wall of a bin. Such a
  /// reading marks free space, but no surface. Infinity: no known object.
  std::vector<float> known_depth{};
  /// Identity of the frame: a hash of its bytes (16 hexadecimal digits), a space and a name. Empty:
  /// none. frame_identity() of viewgain::formats computes it. A map stores the identities of its
  /// frames (MapNotes).
  std::string identity{};

  /// Whether the reading of a pixel shows a known object. `pixel` is the row-major index, which is
  /// not checked.
  [[nodiscard]] bool shows_known(std::size_t pixel) const {
    return !known_depth.empty() && depth[pixel] >= known_depth[pixel];
  }

  /// Depth [m] of the pixel in column u and row v, both counted from 0 and not checked.
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

/// Throws Error(invalid_argument), stating both sizes, unless the frame has the camera's size.
/// Amplitudes and known depths, if any, must have this size too. Constant time.
VIEWGAIN_EXPORT void check_frame_size(const DepthFrame& frame, const PinholeCamera& camera);

}  // namespace viewgain
