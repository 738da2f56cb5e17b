// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A pooled point, and the data that decides whether it is returned.
struct PooledPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< [voxels]
  Eigen::Vector3d toward_free = Eigen::Vector3d::UnitZ();  ///< unit
  double evidence = 0;                                     ///< [frontal views]
  std::uint32_t hits = 0;
};

/// For each point, 1 if its evidence is at least `share` of the upper quartile among the points
/// within `radius` [voxels] whose normals are within 60° of its own, including itself. Removes the
/// sparse points that silhouettes leave around them. The other face of a thin wall is ignored,
/// because it may have been seen far more often. share 0 keeps all.
[[nodiscard]] std::vector<std::uint8_t> well_supported(const std::vector<PooledPoint>& points,
                                                       double radius, double share,
                                                       ThreadPool& pool);

/// Ascending indices of the points to keep. Lengths in voxels; min_distance 0 keeps all. Selects
/// points by most hits first, unless a selected one on their side (normals within 90°) is within
/// `min_distance`. Then reinserts rejected points that would leave a hole and have no selected one
/// within 0.4 `cover`. A hole is a place on the rim of the disc of radius `cover` in the point's
/// tangent plane, one of 8, that is not within `cover` of a selected point. The result depends only
/// on the set of points.
[[nodiscard]] std::vector<std::size_t> thinned(const std::vector<PooledPoint>& points,
                                               double min_distance, double cover, ThreadPool& pool);

}  // namespace viewgain::detail
