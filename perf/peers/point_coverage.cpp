// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "point_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace viewgain::bench {
namespace {

// Cells are as wide as a reading reaches: what is near a point is in its cell or one beside it.
octomap::OcTreeKey cell_of(const Eigen::Vector3d& p) {
  const auto along = [](double x) {
    return static_cast<octomap::key_type>(
        static_cast<std::int32_t>(std::floor(x / kCoveredWithin)) + (1 << 15));
  };
  return {along(p.x()), along(p.y()), along(p.z())};
}

}  // namespace

void PointCoverage::add(std::span<const octomap::point3d> readings) {
  std::unordered_multimap<octomap::OcTreeKey, Eigen::Vector3d, octomap::OcTreeKey::KeyHash> cells;
  for (const octomap::point3d& reading : readings) {
    const Eigen::Vector3d p = Eigen::Vector3f(reading.x(), reading.y(), reading.z()).cast<double>();
    cells.emplace(cell_of(p), p);
  }
  const auto is_near = [&](const Eigen::Vector3d& p) {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3d step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const auto [begin, end] = cells.equal_range(cell_of(p + kCoveredWithin * step));
      for (auto cell = begin; cell != end; ++cell) {
        if ((cell->second - p).norm() <= kCoveredWithin) return true;
      }
    }
    return false;
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (is_covered_[i] == 0 && is_near(points_[i])) is_covered_[i] = 1;
  }
}

double PointCoverage::share() const {
  const auto covered = std::count(is_covered_.begin(), is_covered_.end(), 1);
  return static_cast<double>(covered) / static_cast<double>(points_.size());
}

}  // namespace viewgain::bench
