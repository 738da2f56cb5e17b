// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A point and what supports it.
struct SupportedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [voxels]
  double evidence = 0;
};

/// For each point, whether it has at least `share` of the upper quartile of the evidence within
/// `radius` [voxels], its own included. Silhouettes leave a halo of readings that lie beside the
/// surface and are few compared with those on it. share 0 keeps all.
[[nodiscard]] std::vector<std::uint8_t> well_supported(const std::vector<SupportedPoint>& points,
                                                       double radius, double share,
                                                       ThreadPool& pool);

}  // namespace viewgain::detail
