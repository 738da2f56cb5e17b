// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace viewgain::bench {

/// A point of the true surface is covered if a reading is within this distance [m].
inline constexpr double kCoveredWithin = 0.0025;

/// The share of the points of a surface that are covered by readings.
class PointCoverage {
 public:
  explicit PointCoverage(const std::vector<Eigen::Vector3d>& points) : points_(points) {}

  void add(std::span<const octomap::point3d> readings);  ///< readings in the world frame [m]

  [[nodiscard]] double share() const;

 private:
  const std::vector<Eigen::Vector3d>& points_;
  std::vector<std::uint8_t> is_covered_ = std::vector<std::uint8_t>(points_.size(), 0);
};

}  // namespace viewgain::bench
