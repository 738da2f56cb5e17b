// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace viewgain::detail {

/// Items by the cube that a position [voxels] lies in. Cubes of one map do not share a key.
template <typename Item>
class PointCells {
 public:
  /// Edge of a cube [voxels], at least kLeastEdge: what is within it of a position lies in the 27
  /// cubes round it.
  explicit PointCells(double edge) : edge_(std::max(edge, kLeastEdge)) {}

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

  /// The items of each cube that has some.
  [[nodiscard]] std::vector<const std::vector<Item>*> groups() const {
    std::vector<const std::vector<Item>*> result;
    result.reserve(cells_.size());
    for (const auto& [key, items] : cells_) result.push_back(&items);
    return result;
  }

 private:
  static constexpr double kLeastEdge = 0.1;  // tinier cubes save nothing

  [[nodiscard]] std::int64_t cell(double v) const {
    return static_cast<std::int64_t>(std::floor(v / edge_));
  }
  // A workspace has at most 2^16 voxels an axis, and cubes no edges under 0.1 voxels.
  [[nodiscard]] static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1FFFFFU; };
    return bits(x) << 42U | bits(y) << 21U | bits(z);
  }

  double edge_;
  std::unordered_map<std::uint64_t, std::vector<Item>> cells_;
};

}  // namespace viewgain::detail
