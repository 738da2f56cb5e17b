// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace viewgain::detail {

/// Buckets of points by the cube that a position [voxels] lies in. Cubes of one map do not share a
/// key.
template <typename Bucket>
class PointCells {
 public:
  /// Edge of a cube [voxels], at least kLeastEdge.
  explicit PointCells(double edge) : edge_(std::max(edge, kLeastEdge)) {}

  [[nodiscard]] Bucket& at(const Eigen::Vector3d& p) {
    return cells_[key(cell(p.x()), cell(p.y()), cell(p.z()))];
  }

  [[nodiscard]] double edge() const { return edge_; }

  /// Whether f(bucket) is true for any cube within `radius` of p along each axis. Visits the cubes
  /// in a fixed order and stops at the first true.
  template <typename F>
  [[nodiscard]] bool any_near(const Eigen::Vector3d& p, double radius, F&& f) const {
    const double reach = 1.001 * radius;  // for any rounding of sums and quotients
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = cell(p[static_cast<Eigen::Index>(axis)] - reach);
      high[axis] = cell(p[static_cast<Eigen::Index>(axis)] + reach);
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto found = cells_.find(key(i, j, k));
          if (found != cells_.end() && f(found->second)) return true;
        }
      }
    }
    return false;
  }

  /// The bucket of each cube that has one.
  [[nodiscard]] std::vector<const Bucket*> buckets() const {
    std::vector<const Bucket*> result;
    result.reserve(cells_.size());
    for (const auto& [key, bucket] : cells_) result.push_back(&bucket);
    return result;
  }

 private:
  static constexpr double kLeastEdge = 0.1;  // smaller cubes save nothing

  [[nodiscard]] std::int64_t cell(double v) const {
    return static_cast<std::int64_t>(std::floor(v / edge_));
  }
  // A workspace has at most 2^16 voxels per axis, and cubes no edges below 0.1 voxels.
  [[nodiscard]] static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1FFFFFU; };
    return bits(x) << 42U | bits(y) << 21U | bits(z);
  }

  double edge_;
  std::unordered_map<std::uint64_t, Bucket> cells_;
};

}  // namespace viewgain::detail
