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

/// How much of the 7³ cells round each is free, in a box of cells of 2^shift voxels an edge in the
/// workspace; of a cell that the workspace cuts its part counts for the whole. Beyond the box all
/// is as at its faces. 5 bytes a cell.
class FreeShare {
 public:
  FreeShare(const GridSnapshot& snapshot, const VoxelBox& cells, int shift);

  /// Is all of a cell free? By its place in a dense array [x][y][z], z fastest.
  [[nodiscard]] bool is_free(std::size_t cell) const { return is_free_[cell] != 0; }
  /// Which way more is free, at a cell's place from the box's lowest; in no unit.
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

/// Along how many of the 26 directions to the cells around one comes to free space, before any
/// occupied cell and within a reach, in a box of cells of 2^shift voxels an edge. A cell is free if
/// all of it is, occupied if any voxel of it is; nothing is beyond the box.
class OpenDirections {
 public:
  static constexpr int kDirections = 26;

  /// `free` is of the same box; `reach` in cells, at least 1, at most 63. A diagonal goes by as
  /// many whole steps as its length allows, one at least. Costs some 130 passes over the cells, 64
  /// of them at once, and 2 bytes a cell.
  OpenDirections(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                 const FreeShare& free, int reach);

  /// At a cell's place from the box's lowest; 0 to 26. Of free and occupied cells too.
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

  // One bit a cell, rows along z in whole words and one that is 0; other bits beyond a row's end
  // mean nothing.
  using Bits = std::vector<std::uint64_t>;
  // From each cell so many steps on: has free space come by then; is all still unknown?
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
  std::size_t words_;                 // a row's
  std::array<Bits, kPlanes> counts_;  // bit k of the counts
};

}  // namespace viewgain::detail
