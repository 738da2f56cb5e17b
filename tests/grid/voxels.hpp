// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::test {

template <typename Visit>
void for_each_voxel(const VoxelBox& box, Visit&& visit, std::int32_t step = 1) {
  for (std::int32_t x = box.min.x; x < box.max.x; x += step) {
    for (std::int32_t y = box.min.y; y < box.max.y; y += step) {
      for (std::int32_t z = box.min.z; z < box.max.z; z += step) visit(Index3{x, y, z});
    }
  }
}

template <typename Visit>
void for_each_voxel(const BeliefGrid& grid, Visit&& visit, std::int32_t step = 1) {
  for_each_voxel(VoxelBox::from_dims(grid.min_index(), grid.dims()), visit, step);
}

/// That a snapshot which follows the one before is what one anew is.
inline void expect_same(const GridSnapshot& followed, const GridSnapshot& anew) {
  ASSERT_EQ(followed.tiles, anew.tiles);
  ASSERT_EQ(followed.leaves.size(), anew.leaves.size());
  for (std::size_t i = 0; i < anew.leaves.size(); ++i) {
    ASSERT_EQ(followed.leaves[i].origin, anew.leaves[i].origin);
    ASSERT_EQ(followed.leaves[i].non_free, anew.leaves[i].non_free);
    ASSERT_EQ(followed.leaves[i].occupied, anew.leaves[i].occupied);
    ASSERT_EQ(followed.leaves[i].beliefs, anew.leaves[i].beliefs);
  }
}

}  // namespace viewgain::test
