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

}  // namespace viewgain::detail
