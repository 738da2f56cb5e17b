// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain::detail {

/// Share of free voxels in the 7³ cells around each cell, in a box of cells of 2^shift voxels per
/// edge in the workspace; cells cut by the workspace count by their part inside. Values continue
/// beyond the faces of the box. 5 bytes per cell.
class FreeShare {
 public:
  FreeShare(const GridSnapshot& snapshot, const VoxelBox& cells, int shift);

  /// Whether a cell is entirely free, by its index in a dense array [x][y][z], z fastest.
  [[nodiscard]] bool is_free(std::size_t cell) const { return is_free_[cell] != 0; }
  /// Gradient of free space at a cell, relative to the box's lowest cell; not normalised.
  [[nodiscard]] Eigen::Vector3d gradient(int x, int y, int z) const;

 private:
  void count(const GridSnapshot& snapshot, int shift);
  void settle(const VoxelBox& workspace, int shift);
  void add_up(std::size_t stride, std::size_t count);

  VoxelBox cells_;
  std::array<int, 3> size_;
  std::vector<std::int32_t> sums_;  // free voxels of a cell, then of 7³ cells
  std::vector<std::uint8_t> is_free_;
};

/// Number of the 26 directions along which free space comes within a reach, before any occupied
/// cell, in a box of cells of 2^shift voxels per edge. A cell is free if all of it is, occupied if
/// any voxel is; beyond the box there is nothing.
class OpenDirections {
 public:
  static constexpr int kDirections = 26;

  /// `free` belongs to the same box; `reach` in cells, 1 to 63. A diagonal takes as many whole
  /// steps as its length allows, at least one. Cost: about 130 passes over the cells, 64 cells at
  /// once, and 2 bytes per cell.
  OpenDirections(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                 const FreeShare& free, int reach);

  /// Result at a cell relative to the box's lowest; 0 to 26. Also for free and occupied cells.
  [[nodiscard]] int count(std::size_t x, std::size_t y, std::size_t z) const {
    const std::size_t word = word_of(x * size_[1] + y, z);
    int sum = 0;
    for (std::size_t k = 0; k < kPlanes; ++k) {
      sum += static_cast<int>(counts_[k][word] >> (z % 64) & 1U) << k;
    }
    return sum;
  }

 private:
  static constexpr std::size_t kPlanes = 5;  // bits of a count

  // One bit per cell: rows along z in whole words followed by a zero word; bits beyond a row's end
  // are undefined.
  using Bits = std::vector<std::uint64_t>;
  // A number of steps from each cell: whether free space has been reached, and whether all is still
  // unknown.
  struct Steps {
    Bits free, unknown;
  };
  using Direction = std::array<int, 3>;

  [[nodiscard]] std::size_t word_of(std::size_t row, std::size_t z) const {
    return 1 + row * words_ + z / 64;
  }
  [[nodiscard]] Steps joined(const Steps& first, const Steps& then, const Direction& by,
                             int steps) const;
  void add(const Bits& bits);

  std::array<std::size_t, 3> size_;
  std::size_t words_;                 // words of a row
  std::array<Bits, kPlanes> counts_;  // bit k of the counts
};

}  // namespace viewgain::detail
