// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "point_cells.hpp"

namespace viewgain::detail {

/// Takes points one by one and refuses those that are nearer than a distance to one it has taken.
class PointThinning {
 public:
  explicit PointThinning(double min_distance)
      : cells_(std::max(min_distance, kLeastEdge)), limit_(min_distance * min_distance) {}

  [[nodiscard]] bool accept(const Eigen::Vector3d& point) {
    bool crowded = false;
    cells_.for_each_near(point, [&](const Eigen::Vector3d& other) {
      crowded = crowded || (other - point).squaredNorm() < limit_;
    });
    if (!crowded) cells_.at(point).push_back(point);
    return !crowded;
  }

 private:
  /// Tinier cubes than this save nothing, and their numbers would not fit into an integer.
  static constexpr double kLeastEdge = 0.1;

  PointCells<Eigen::Vector3d> cells_;
  double limit_;
};

}  // namespace viewgain::detail
