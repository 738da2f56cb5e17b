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

/// Depth image along the optical axis (z, not range) [m], row by row. Three kinds of pixel:
/// a reading (0 < z < infinity), kInvalid, kOutOfRange. A value type.
struct VIEWGAIN_EXPORT DepthFrame {
  static constexpr float kInvalid = 0.0F;  ///< a depth [m] that says nothing
  static constexpr float kOutOfRange =
      std::numeric_limits<float>::infinity();  ///< a depth [m]: nothing up to max_range
  static constexpr float kSaturated =
      std::numeric_limits<float>::infinity();  ///< an amplitude [m⁻²] at full scale: not known

  int width = 0;             ///< [px]
  int height = 0;            ///< [px]
  std::vector<float> depth;  ///< width * height values
  /// Empty, or width * height values: the returned signal cosθ / t² [m⁻²], θ the angle of incidence
  /// and t the range, for a diffuse surface as bright as the sensor's noise model assumes. Where it
  /// is kSaturated, the angle comes from the depths.
  std::vector<float> amplitude{};
  /// Empty, or width * height values: from which depth [m] on a pixel's reading is of something
  /// that is known and no part of the map, say the wall of a bin; infinity: none is. ObstacleView
  /// sets it. Such readings carve but do not hit.
  std::vector<float> known_depth{};
  /// Tells this frame from all others, or empty: 16 hexadecimal digits over its bytes, a space and
  /// a name, as frame_identity() of viewgain::formats makes it. A map notes the identities of the
  /// frames in it (MapNotes).
  std::string identity{};

  /// Is this pixel's reading of what is known to be there? The index, row by row, is not checked.
  [[nodiscard]] bool shows_known(std::size_t pixel) const {
    return !known_depth.empty() && depth[pixel] >= known_depth[pixel];
  }

  /// The depth [m] of pixel (u, v): column, row, both from 0 and unchecked.
  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)];
  }
  /// Are the images equal? The identity does not count.
  bool operator==(const DepthFrame& other) const {
    return width == other.width && height == other.height && depth == other.depth &&
           amplitude == other.amplitude && known_depth == other.known_depth;
  }
};

/// Throws Error(invalid_argument), with both sizes, unless the frame, and its amplitudes and known
/// depths if it has any, has the camera's size. Takes constant time.
VIEWGAIN_EXPORT void check_frame_size(const DepthFrame& frame, const PinholeCamera& camera);

}  // namespace viewgain
