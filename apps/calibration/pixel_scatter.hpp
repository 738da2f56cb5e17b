// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "viewgain/core/camera.hpp"

namespace viewgain::detail {

/// Median; the mean of the middle two for an even count. Requires at least one value.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Ranges of a pixel over time, for a static scene.
struct PixelScatter {
  double median = 0;    ///< [m]; 0: too few readings
  double mean = 0;      ///< [m]
  double variance = 0;  ///< [m²]
  bool moves = false;   ///< readings depend on time
};

/// Results per pixel; empty for pixels with readings in fewer than nine of ten frames. `depths`:
/// frames of equal size.
[[nodiscard]] std::vector<PixelScatter> scatter_of(const std::vector<std::vector<float>>& depths,
                                                   const std::vector<Eigen::Vector3d>& rays);

/// Noise of a pixel's position, from depth jumps.
struct EdgeScatter {
  double length = 0;         ///< of the edges used [px]
  double sigma_px = 0;       ///< [px]
  double sigma_lateral = 0;  ///< across the ray, if it were equal at all ranges [m]
};

/// `sigma`: approximate noise along the ray [m]. Jumps must exceed 8 sigma and 5 % of the range.
/// The length is 0 if there are none.
[[nodiscard]] EdgeScatter edge_scatter(const PinholeCamera& camera,
                                       const std::vector<std::vector<float>>& depths,
                                       const std::vector<Eigen::Vector3d>& rays,
                                       const std::vector<PixelScatter>& pixels, double sigma);

}  // namespace viewgain::detail
