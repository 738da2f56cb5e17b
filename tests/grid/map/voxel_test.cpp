// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Boxes of voxels, and the way between voxels and the world.

#include "viewgain/grid/voxel.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <random>

#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {

TEST(Voxel, WorldToVoxelAndBack) {
  const Pose T_world_grid(
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix(),
      {0.4, -1.3, 2.0});
  const double V = 0.02;
  const BeliefGrid grid({V, {{-0.1, 0.06, -0.32}, {0.26, 0.2, 0.02}}, T_world_grid, 0.01});
  const GridSnapshot snapshot = grid.snapshot();
  const VoxelBox box = VoxelBox::from_dims(grid.min_index(), grid.dims());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> inside(-0.499, 0.499);
  std::uint64_t voxels = 0;
  for (int x = box.min.x; x < box.max.x; ++x) {
    for (int y = box.min.y; y < box.max.y; ++y) {
      for (int z = box.min.z; z < box.max.z; ++z) {
        const Index3 voxel{x, y, z};
        const Eigen::Vector3d in_grid = T_world_grid.inverse() * grid.center(voxel);
        ASSERT_NEAR(in_grid.x(), (x + 0.5) * V, 1e-12);
        ASSERT_NEAR(in_grid.y(), (y + 0.5) * V, 1e-12);
        ASSERT_NEAR(in_grid.z(), (z + 0.5) * V, 1e-12);
        ASSERT_EQ(snapshot.center(voxel), grid.center(voxel));
        const Eigen::Vector3d off(inside(random), inside(random), inside(random));
        const Eigen::Vector3d p = grid.center(voxel) + T_world_grid.rotation() * (V * off);
        ASSERT_EQ(grid.index_of(p), voxel);
        ASSERT_EQ(snapshot.index_of(p), voxel);
        ++voxels;
      }
    }
  }
  EXPECT_EQ(voxels, grid.voxel_count());

  // Voxels outside have a centre, but no point finds them.
  for (const Index3 outside :
       {Index3{box.min.x - 1, box.min.y, box.min.z}, Index3{box.min.x, box.max.y, box.min.z},
        Index3{box.min.x, box.min.y, box.max.z}}) {
    EXPECT_NEAR(
        (grid.center(outside) - grid.center(box.min)).norm(),
        V * Eigen::Vector3d(outside.x - box.min.x, outside.y - box.min.y, outside.z - box.min.z)
                .norm(),
        1e-12);
    EXPECT_EQ(grid.index_of(grid.center(outside)), std::nullopt);
  }
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    EXPECT_EQ(grid.index_of({0.4, bad, 2.0}), std::nullopt) << bad;
    EXPECT_EQ(snapshot.index_of({0.4, bad, 2.0}), std::nullopt) << bad;
  }
}

TEST(Voxel, OffsetsInALeafAndBack) {
  for (const Index3 origin : {Index3{0, 0, 0}, Index3{-8, 16, -1048576}}) {
    LeafMask mask{};
    for (unsigned offset = 0; offset < 512; ++offset) {
      ASSERT_EQ(block_offset(offset_voxel(origin, offset)), offset);
      ASSERT_FALSE(test_bit(mask, offset));
      set_bit(mask, offset);
      ASSERT_TRUE(test_bit(mask, offset));
    }
  }
  EXPECT_EQ(block_offset({1, 2, 3}), 64U + 16 + 3);
  EXPECT_EQ(block_offset({-1, -8, -7}), 7 * 64U + 1);
}

TEST(Voxel, BoxesAreHalfOpen) {
  const VoxelBox box{{-2, 0, 5}, {1, 4, 7}};
  EXPECT_EQ(box, VoxelBox::from_dims({-2, 0, 5}, {3, 4, 2}));
  EXPECT_EQ(box.volume(), 24U);
  EXPECT_TRUE(box.contains({-2, 3, 6}));
  EXPECT_FALSE(box.contains({1, 3, 6}));
  EXPECT_FALSE(box.contains({-2, 4, 6}));
  EXPECT_FALSE(box.contains({-2, 3, 4}));
  // A point on a shared face belongs to the larger index.
  EXPECT_EQ(box.voxel_at({-2.0, 0.0, 5.0}), (Index3{-2, 0, 5}));
  EXPECT_EQ(box.voxel_at({-0.5, 1.0, 6.5}), (Index3{-1, 1, 6}));
  EXPECT_EQ(box.voxel_at({1.0, 1.0, 6.5}), std::nullopt);

  EXPECT_EQ(box.intersection({{-1, -9, 6}, {9, 2, 9}}), (VoxelBox{{-1, 0, 6}, {1, 2, 7}}));
  EXPECT_EQ(box.intersection({{1, 0, 5}, {2, 4, 7}}).volume(), 0U);
  EXPECT_EQ(box.intersection({{5, 9, 9}, {6, 10, 10}}).volume(), 0U);
  const std::int32_t far = 1 << 30;
  EXPECT_EQ((VoxelBox{{-far, 0, 0}, {far, 1, 1}}).volume(), std::uint64_t{1} << 31U);
}

}  // namespace
}  // namespace viewgain
