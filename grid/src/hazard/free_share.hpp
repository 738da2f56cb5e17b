// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Free voxels in a box of cells of 2^shift voxels per edge in the workspace. Cells cut by the
/// workspace count by their part inside. Values continue beyond the faces of the box. 3 bytes per
/// cell.
class FreeShare {
 public:
  FreeShare(const GridSnapshot& snapshot, const VoxelBox& cells, int shift, ThreadPool& pool);

  /// Whether a cell is entirely free, by its index in a dense array [x][y][z], z fastest: 0 or 1.
  [[nodiscard]] const std::uint8_t* is_free() const { return is_free_.get(); }
  /// Gradient of the free voxels in the 7³ cells around a cell of the box, relative to the box's
  /// lowest cell; not normalised. Reads 154 cells.
  [[nodiscard]] Eigen::Vector3d gradient(int x, int y, int z) const;

 private:
  void subtract_leaves(const GridSnapshot& snapshot, ThreadPool& pool);
  void subtract_tiles(const GridSnapshot& snapshot, int x);
  void settle(const VoxelBox& workspace, int x);
  void add_up_rows(int x);
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>((x * size_[1] + y) * std::ptrdiff_t{size_[2]} + z);
  }
  // Voxels of the cells in a plane of the box.
  [[nodiscard]] VoxelBox voxels_of(int x) const;

  VoxelBox cells_;
  int shift_;
  std::array<int, 3> size_;
  std::unique_ptr<std::uint16_t[]> sums_;  // free voxels of a cell, then of 7 cells along z
  std::unique_ptr<std::uint8_t[]> is_free_;
};

}  // namespace viewgain::detail
