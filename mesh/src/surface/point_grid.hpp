// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {

using Point3 = std::array<double, 3>;

[[nodiscard]] inline double squared_distance(const Point3& a, const Point3& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

/// Points sorted into cubic cells, for searches within about the size of a cell. Cells that are
/// 2^21 apart share a key, which costs time but not correctness, because distances are checked.
class PointGrid {
 public:
  PointGrid(std::span<const Point3> points, double cell_size);

  /// Calls visit(index, squared distance) for every point at most `radius` from p.
  template <typename Visit>
  void for_each_within(const Point3& p, double radius, const Visit& visit) const {
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = cell_of(p[k] - radius);
      high[k] = cell_of(p[k] + radius);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const Cell& cell = cells_[slot_of(key_of(x, y, z))];
          for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const double d2 = squared_distance(sorted_[i], p);
            if (d2 <= radius * radius) visit(order_[i], d2);
          }
        }
      }
    }
  }

  /// Indices of all points, those of a cell together.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

 private:
  static constexpr double kMost = 0x1p62;  // cells along an axis in each direction

  [[nodiscard]] std::int64_t cell_of(double x) const {
    // Points beyond the last cell belong to the last cell.
    return static_cast<std::int64_t>(std::clamp(std::floor(x * inverse_cell_size_), -kMost, kMost));
  }
  [[nodiscard]] static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::uint64_t kMask = (1U << 21U) - 1;
    return (static_cast<std::uint64_t>(x) & kMask) << 42U |
           (static_cast<std::uint64_t>(y) & kMask) << 21U | (static_cast<std::uint64_t>(z) & kMask);
  }

  // Slot of the cell with this key, or a free slot for it.
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    std::size_t slot = key * kMixStep >> shift_;
    while (cells_[slot].end != 0 && cells_[slot].key != key) {
      slot = (slot + 1) & (cells_.size() - 1);
    }
    return slot;
  }

  double inverse_cell_size_;
  std::vector<std::uint32_t> order_;
  std::vector<Point3> sorted_;  // the points in this order, so that those of a cell are adjacent
  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t begin = 0, end = 0;  // into order_; both 0: no cell
  };
  // A hash table with open addressing, at most half full, because searches look up 27 cells and
  // more.
  std::vector<Cell> cells_;
  unsigned shift_;  // shifts a hash to the number of a slot
};

}  // namespace viewgain::detail
