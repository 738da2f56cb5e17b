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

/// Fused points as the arrays that quality and files ask for, entry i of point i.
struct VIEWGAIN_EXPORT PointArrays {
  std::vector<std::array<double, 3>> positions;  ///< world [m]
  std::vector<std::array<double, 3>> normals;    ///< unit, toward free space
  std::vector<SymmetricMatrix3> covariances;     ///< [m²]
};

/// Copies of places, normals and sigmas.
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
