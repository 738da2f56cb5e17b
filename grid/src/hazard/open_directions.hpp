// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cell_kernels.hpp"
#include "free_share.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Number of the 26 directions along which free space comes within a reach, before any occupied
/// cell, in a box of cells of 2^shift voxels per edge. A cell is free if all of it is, occupied if
/// any voxel is; beyond the box there is nothing.
class OpenDirections {
 public:
  static constexpr int kDirections = 26;

  /// `free` belongs to the same box; `reach` in cells, 1 to 63. A diagonal takes as many whole
  /// steps as its length allows, at least one. Cost: about 130 passes over the cells on all
  /// threads, at least 64 cells at once, and 2 bytes per cell and thread.
  OpenDirections(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                 const FreeShare& free, int reach, ThreadPool& pool);

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
  using Counts = std::array<Bits, kPlanes>;  // bit k of the counts

  [[nodiscard]] std::size_t word_of(std::size_t row, std::size_t z) const {
    return 1 + row * words_ + z / 64;
  }
  [[nodiscard]] Steps cells_of(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                               const FreeShare& free, ThreadPool& pool) const;
  void go(const Steps& here, const Direction& by, unsigned wanted, std::array<Steps, 3>& buffers,
          Counts& counts) const;
  void join(const Steps* first, const Steps& then, const Direction& by, int steps,
            Steps& result) const;
  void add(const Bits& bits, std::size_t plane, Counts& counts) const;

  std::array<std::size_t, 3> size_;
  std::size_t words_;  // words of a row
  const CellKernels& kernels_;
  Counts counts_;
};

}  // namespace viewgain::detail
