// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "viewgain/core/covariance.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/fused_points.hpp"

namespace viewgain {

/// Fused points as the arrays that quality and files ask for.
struct VIEWGAIN_EXPORT PointArrays {
  std::vector<std::array<double, 3>> positions;  ///< entry i of point i, world [m]
  std::vector<std::array<double, 3>> normals;    ///< likewise, unit vectors toward free space
  std::vector<SymmetricMatrix3> covariances;     ///< entry i of point i [m²]
};

/// Copies of the points' places, normals and covariances, in their order. Checks nothing. Costs
/// O(points).
[[nodiscard]] inline PointArrays arrays_of(std::span<const FusedPoint> points) {
  PointArrays arrays;
  arrays.positions.reserve(points.size());
  arrays.normals.reserve(points.size());
  arrays.covariances.reserve(points.size());
  for (const FusedPoint& point : points) {
    arrays.positions.push_back(point.position);
    arrays.normals.push_back(point.toward_free);
    arrays.covariances.push_back(point.covariance);
  }
  return arrays;
}

}  // namespace viewgain
