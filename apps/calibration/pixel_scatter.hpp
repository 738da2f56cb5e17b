// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "viewgain/core/camera.hpp"

namespace viewgain::detail {

/// The value in the middle, of an even count the mean of both; there is at least one.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// What a pixel of a static scene read over time, along its ray.
struct PixelScatter {
  double median = 0;    ///< [m]; 0: too few readings
  double mean = 0;      ///< [m]
  double variance = 0;  ///< [m²]
  bool moves = false;   ///< readings depend on time
};

/// One a pixel, of those that read in nine of ten frames. `depths` are frames of one size.
[[nodiscard]] std::vector<PixelScatter> scatter_of(const std::vector<std::vector<float>>& depths,
                                                   const std::vector<Eigen::Vector3d>& rays);

/// By how much a pixel's place scatters, at jumps of depth.
struct EdgeScatter {
  double length = 0;         ///< of the edges that tell it [px]
  double sigma_px = 0;       ///< [px]
  double sigma_lateral = 0;  ///< across the ray, were it the same at all ranges [m]
};

/// `sigma` is about how readings scatter along the ray [m]; jumps are larger than 8 of them and 5 %
/// of the range. No length where there are none.
[[nodiscard]] EdgeScatter edge_scatter(const PinholeCamera& camera,
                                       const std::vector<std::vector<float>>& depths,
                                       const std::vector<Eigen::Vector3d>& rays,
                                       const std::vector<PixelScatter>& pixels, double sigma);

}  // namespace viewgain::detail
