// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace viewgain::detail {

/// Above every squared distance that is found.
inline constexpr std::uint16_t kNoDistance = 0xFFFF;

/// A dense array [x][y][z], z fastest.
using CellBox = std::array<std::size_t, 3>;

/// Where the nearest cell is in which something is.
class NearestCells {
 public:
  /// Replaces 0 (something is here) and kNoDistance in a dense array by the squared Euclidean
  /// distance to the nearest 0 [cells²], exactly; kNoDistance beyond `reach`, at most 127. Costs at
  /// most reach × cells / 2 steps of 8 cells, less where something is near or nothing in reach, and
  /// 3 bytes a cell.
  NearestCells(std::vector<std::uint16_t>& cells, const CellBox& size, int reach);

  /// From a cell with a distance to the nearest with 0; to one of them if there are several.
  [[nodiscard]] std::array<int, 3> offset(std::size_t x, std::size_t y, std::size_t z) const;

 private:
  CellBox size_;
  std::vector<std::int8_t> along_x_, along_y_, along_z_;  // [cells]; each where it is known
};

}  // namespace viewgain::detail
