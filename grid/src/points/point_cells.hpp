// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace viewgain::detail {

/// Items by the cube that a position lies in; cubes that share a key do no harm to callers that
/// check distances.
template <typename Item>
class PointCells {
 public:
  /// Edge of a cube; what is within it of a position lies in the 27 cubes round it.
  explicit PointCells(double edge) : edge_(edge) {}

  [[nodiscard]] std::vector<Item>& at(const Eigen::Vector3d& p) {
    return cells_[key(cell(p.x()), cell(p.y()), cell(p.z()))];
  }

  /// f(item) for all items in the cube of p and its neighbours, in a fixed order.
  template <typename F>
  void for_each_near(const Eigen::Vector3d& p, F&& f) const {
    const std::int64_t x = cell(p.x()), y = cell(p.y()), z = cell(p.z());
    for (std::int64_t i = x - 1; i <= x + 1; ++i) {
      for (std::int64_t j = y - 1; j <= y + 1; ++j) {
        for (std::int64_t k = z - 1; k <= z + 1; ++k) {
          const auto found = cells_.find(key(i, j, k));
          if (found == cells_.end()) continue;
          for (const Item& item : found->second) f(item);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::int64_t cell(double v) const {
    return static_cast<std::int64_t>(std::floor(v / edge_));
  }
  [[nodiscard]] static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
           static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ULL;
  }

  double edge_;
  std::unordered_map<std::uint64_t, std::vector<Item>> cells_;
};

}  // namespace viewgain::detail
