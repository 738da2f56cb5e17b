// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Larger than any squared distance found.
inline constexpr std::uint16_t kNoDistance = 0xFFFF;

/// A dense array [x][y][z], z fastest.
using CellBox = std::array<std::size_t, 3>;

/// The nearest occupied cell of each cell.
class NearestCells {
 public:
  /// Replaces the values of a dense array, 0 (occupied) and kNoDistance, by the exact squared
  /// Euclidean distance to the nearest 0 [cells²]; kNoDistance beyond `reach`, at most 127. Cost:
  /// at most reach × cells / 2 steps of 8 cells, and 3 bytes per cell.
  NearestCells(std::vector<std::uint16_t>& cells, const CellBox& size, int reach, ThreadPool& pool);

  /// Offset from a cell with a distance to a nearest 0.
  [[nodiscard]] std::array<int, 3> offset(std::size_t x, std::size_t y, std::size_t z) const;

 private:
  CellBox size_;
  std::unique_ptr<std::int8_t[]> along_x_, along_y_,
      along_z_;  // [cells]; valid where distances are
};

}  // namespace viewgain::detail
