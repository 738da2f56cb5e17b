// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Depth image along the optical axis (z, not range) [m], row by row. Three kinds of pixel
/// (DESIGN.md section 5): a reading (0 < z < infinity), kInvalid, kOutOfRange. A value type.
struct VIEWGAIN_EXPORT DepthFrame {
  static constexpr float kInvalid = 0.0F;  ///< says nothing
  static constexpr float kOutOfRange =
      std::numeric_limits<float>::infinity();  ///< nothing up to max_range

  int width = 0;             ///< [px]
  int height = 0;            ///< [px]
  std::vector<float> depth;  ///< width * height values
  /// Empty, or width * height values: the returned signal cosθ / t² [m⁻²], θ the angle of incidence
  /// and t the range, for a diffuse surface as bright as the sensor's noise model assumes.
  std::vector<float> amplitude{};

  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)];
  }
  bool operator==(const DepthFrame&) const = default;
};

}  // namespace viewgain
