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

/// Surface points of a map as arrays, for quality figures and files.
struct VIEWGAIN_EXPORT PointArrays {
  std::vector<std::array<double, 3>> positions;  ///< position of point i, world [m]
  std::vector<std::array<double, 3>> normals;    ///< unit vector towards free space of point i
  std::vector<SymmetricMatrix3> covariances;     ///< covariance of point i [m²]
};

/// Copies the positions, normals and covariances of the points, in order. Checks nothing. Cost:
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
