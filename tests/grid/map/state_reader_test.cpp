// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/state_reader.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace viewgain {
namespace {

TEST(StateReader, ReadsTheStatesOfTheGrid) {
  std::mt19937 random(17);
  const auto any = [&](int size) {
    return std::uniform_int_distribution<int>(0, size - 1)(random);
  };
  BeliefGrid grid({.voxel_size = 0.01, .workspace = {{-0.7, -0.33, -0.5}, {0.9, 0.41, 0.3}}});
  const Index3 low = grid.min_index(), dims = grid.dims();
  const VoxelBox workspace = VoxelBox::from_dims(low, dims);
  for (int k = 0; k < 40; ++k) {  // tiles and leaves
    const Index3 from{low.x + any(dims.x), low.y + any(dims.y), low.z + any(dims.z)};
    const VoxelBox box =
        VoxelBox::from_dims(from, {1 + any(40), 1 + any(40), 1 + any(40)}).intersection(workspace);
    const auto state = static_cast<std::uint8_t>(any(3));
    grid.update_box(box, std::vector<std::uint8_t>(box.volume(), state));
  }
  StateReader reader(grid);
  std::array<int, 3> seen{};
  int outside = 0;
  for (int walk = 0; walk < 300; ++walk) {
    Index3 v{low.x + any(dims.x), low.y + any(dims.y), low.z + any(dims.z)};
    for (int step = 0; step < 200; ++step) {
      ASSERT_EQ(reader.state(v), grid.state(v)) << v.x << " " << v.y << " " << v.z;
      ++seen[static_cast<std::size_t>(grid.state(v))];
      outside += workspace.contains(v) ? 0 : 1;
      v = {v.x + any(3) - 1, v.y + any(3) - 1, v.z + any(4) - 1};
    }
  }
  for (const int count : seen) EXPECT_GT(count, 1000);
  EXPECT_GT(outside, 2000);
}

TEST(VoxelOf, RoundsDown) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1e6, 1e6), near(-3, 3);
  int cases = 0;
  const auto check = [&](double x) {
    const Index3 voxel = voxel_of({x, -x, x});
    EXPECT_EQ(voxel.x, static_cast<std::int32_t>(std::floor(x))) << x;
    EXPECT_EQ(voxel.y, static_cast<std::int32_t>(std::floor(-x))) << x;
    EXPECT_EQ(voxel.z, voxel.x);
    ++cases;
  };
  for (int k = 0; k < 5000; ++k) check(anywhere(random)), check(near(random));
  for (const double x : {0.0, -0.0, 1.0, -1.0, 2147483646.0, -2147483646.5, 1e-300, -1e-300}) {
    check(x);
  }
  EXPECT_EQ(cases, 10'008);
}

}  // namespace
}  // namespace viewgain
