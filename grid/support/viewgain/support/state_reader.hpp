// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain {

/// BeliefGrid::state() for consecutive voxels, fast within a block of 8³. The grid must not change.
/// Use one object per thread.
class VIEWGAIN_EXPORT StateReader {
 public:
  explicit StateReader(const BeliefGrid& grid)
      : grid_(grid), box_(VoxelBox::from_dims(grid.min_index(), grid.dims())) {}

  [[nodiscard]] VoxelState state(Index3 voxel) {
    if (!box_.contains(voxel)) return VoxelState::unknown;
    const Index3 block{voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
    if (!(block == block_)) enter(block);
    return detail::code_state(codes_ != nullptr ? codes_[block_offset(voxel)] : tile_code_);
  }

 private:
  void enter(Index3 block);

  const BeliefGrid& grid_;
  VoxelBox box_;
  Index3 block_{std::numeric_limits<std::int32_t>::max(), 0, 0};  // divided by 8; none yet
  const std::uint8_t* codes_ = nullptr;  // of the block; null if it is uniform
  std::uint8_t tile_code_ = detail::kUnknownCode;
};

}  // namespace viewgain
