// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// States of the cells of 2^shift voxels per edge, by look-up, in a box of cells that touch the
/// workspace. A cell cut by the workspace counts by its part inside. Const members may run from
/// many threads.
class BlockMasks {
 public:
  enum class Cell : std::uint8_t {
    not_looked_up = 0,
    free,      ///< all of it
    occupied,  ///< some of it
    other,
  };

  BlockMasks(const GridSnapshot& snapshot, const VoxelBox& cells, int shift);

  /// Free voxels of a cell, scaled to a whole cell (rounded down).
  [[nodiscard]] int free_voxels(Index3 cell) const;
  /// Counts voxels only the first time.
  [[nodiscard]] Cell state(Index3 cell) const {
    const auto part = [](std::int32_t at, std::int32_t low) {
      return static_cast<std::size_t>(at - low);
    };
    const std::size_t i =
        (part(cell.x, cells_.min.x) * rows_y_ + part(cell.y, cells_.min.y)) * rows_z_ +
        part(cell.z, cells_.min.z);
    // Several threads may store the same value.
    const std::atomic_ref<Cell> known(known_[i]);
    Cell state = known.load(std::memory_order_relaxed);
    if (state == Cell::not_looked_up) {
      state = looked_up(cell);
      known.store(state, std::memory_order_relaxed);
    }
    return state;
  }

 private:
  static constexpr std::int32_t kFree = -1, kUnknown = -2;  // instead of an index
  struct Masks {
    LeafMask non_free, occupied;
  };

  [[nodiscard]] std::int32_t& entry(Index3 voxel) { return blocks_[index(voxel)]; }
  [[nodiscard]] std::size_t index(Index3 v) const {
    const auto part = [](std::int32_t at, std::int32_t low) {
      return static_cast<std::size_t>((at >> 3) - low);
    };
    return (part(v.x, low_.x) * size_y_ + part(v.y, low_.y)) * size_z_ + part(v.z, low_.z);
  }
  [[nodiscard]] Index3 lowest(Index3 cell) const {
    return {cell.x * (1 << shift_), cell.y * (1 << shift_), cell.z * (1 << shift_)};
  }
  [[nodiscard]] Cell looked_up(Index3 cell) const;
  // Voxels of a cell in the workspace.
  [[nodiscard]] int inside(Index3 lowest) const;
  // Bits of a mask in the cell whose lowest voxel this is.
  [[nodiscard]] int count(const LeafMask& mask, Index3 lowest) const;
  [[nodiscard]] int non_free(Index3 lowest, int inside) const;

  int shift_;
  VoxelBox cells_;
  std::size_t rows_y_, rows_z_;  // cells along y and z
  VoxelBox workspace_;
  bool is_cut_;  // whether the workspace cuts cells of the box
  Index3 low_;   // lowest block of the box
  std::size_t size_y_, size_z_;
  std::vector<std::int32_t> blocks_;  // kFree, kUnknown or an index
  std::vector<Masks> masks_;
  std::unique_ptr<Cell[]> known_;  // state of each cell
};

}  // namespace viewgain::detail
