// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A pooled point, and what decides whether it is delivered.
struct PooledPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< [voxels]
  Eigen::Vector3d toward_free = Eigen::Vector3d::UnitZ();  ///< unit
  double evidence = 0;                                     ///< [frontal views]
  std::uint32_t hits = 0;
};

/// For each point, whether it has at least `share` of the upper quartile of the evidence of the
/// points within `radius` [voxels] whose normals are within 60° of its own, itself included.
/// Silhouettes leave a halo of readings beside the surface, few compared with those on it; the
/// other face of a thin wall may have been seen far more often and is ignored. share 0 keeps all.
[[nodiscard]] std::vector<std::uint8_t> well_supported(const std::vector<PooledPoint>& points,
                                                       double radius, double share,
                                                       ThreadPool& pool);

/// Ascending indices of the points to keep; lengths in voxels. Most hits first, a point is taken
/// unless one already taken on its side (normals within 90°) is within `min_distance`. Then
/// rejected points are put back, most hits first, if the circle of radius `cover` round them in the
/// tangent plane, looked at in 8 directions, is not within `cover` of those taken, unless one of
/// these is within 0.4 `cover`. So what lies within r >= `cover` of any point lies, but for rare
/// gaps, within r of one that is kept. A function of the set of points alone; min_distance 0 keeps
/// all.
[[nodiscard]] std::vector<std::size_t> thinned(const std::vector<PooledPoint>& points,
                                               double min_distance, double cover, ThreadPool& pool);

}  // namespace viewgain::detail
