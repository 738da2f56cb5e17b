// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A map that follows a dense array of states, box by box.

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {

// Over a border of OpenVDB's nodes of 128³ voxels, off the blocks' lattice.
const GridConfig kConfig{0.01, {{-0.13, 1.15, -0.05}, {0.06, 1.45, 0.15}}, {}, 0.01};

using test::for_each_voxel;

struct Voxel {
  std::optional<float> log_odds;
  std::optional<Belief> belief;
  [[nodiscard]] std::uint8_t state() const { return !log_odds ? 0 : *log_odds > 0 ? 2 : 1; }
};

// Against a dense array of what each voxel must be.
TEST(UpdateBox, VoxelsAreWhatTheArraySaysOthersAsBefore) {
  BeliefGrid grid(kConfig);
  const VoxelBox all = VoxelBox::from_dims(grid.min_index(), grid.dims());
  const auto place = [&](Index3 v) {
    const Index3 d = grid.dims();
    return static_cast<std::size_t>(((v.x - all.min.x) * d.y + v.y - all.min.y) * d.z + v.z -
                                    all.min.z);
  };
  std::vector<Voxel> expected(grid.voxel_count());
  std::mt19937 random(11);
  const auto between = [&](std::int32_t low, std::int32_t end) {
    return low + static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(end - low));
  };
  const auto voxel_from = [&](Index3 low) {
    return Index3{between(low.x, all.max.x), between(low.y, all.max.y), between(low.z, all.max.z)};
  };
  constexpr std::array<float, 3> kLogOdds{0, -0.4F, 0.85F};
  std::size_t changes = 0, kept_beliefs = 0, lost_beliefs = 0, rounds = 0;
  for (; rounds < 60; ++rounds) {
    if (rounds % 3 == 0) {  // what a sensor has seen
      std::vector<BeliefGrid::VoxelValue> values;
      for (int i = 0; i < 2000; ++i) {
        const Belief belief{{1, 2, 3, 0, 0, 0}, {}, 1 + static_cast<std::uint32_t>(i % 9)};
        values.push_back({voxel_from(all.min), i % 4 == 0 ? -1.0F : 1.5F, belief});
        expected[place(values.back().voxel)] = {values.back().log_odds, belief};
      }
      grid.set(values);
    }
    const GridSnapshot before = grid.snapshot();
    VoxelBox box = all;
    if (rounds % 10 != 9) {
      box.min = voxel_from(all.min);
      const Index3 last = voxel_from(box.min);
      box.max = {last.x + 1, last.y + 1, last.z + 1};
    }
    std::vector<std::uint8_t> states;
    std::uint64_t wanted = 0;
    const bool is_uniform = rounds % 4 == 1;
    const auto one = static_cast<std::uint8_t>(between(0, 3));
    for_each_voxel(box, [&](Index3 at) {
      Voxel& voxel = expected[place(at)];
      states.push_back(is_uniform          ? one
                       : random() % 3 == 0 ? static_cast<std::uint8_t>(between(0, 3))
                                           : voxel.state());
      const bool is_same = states.back() == voxel.state();
      (is_same ? kept_beliefs : lost_beliefs) += voxel.belief ? 1 : 0;
      if (is_same) return;
      ++wanted;
      voxel = {};
      if (states.back() != 0) voxel.log_odds = kLogOdds[states.back()];
    });
    ASSERT_EQ(grid.update_box(box, states), wanted);
    changes += wanted;
    for_each_voxel(all, [&](Index3 at) {
      const Voxel& voxel = expected[place(at)];
      const std::optional<float> log_odds = grid.log_odds(at);
      ASSERT_EQ(log_odds.has_value(), voxel.log_odds.has_value());
      if (log_odds) {
        ASSERT_NEAR(*log_odds, *voxel.log_odds, 1e-6);
      }
      ASSERT_EQ(grid.belief(at), voxel.belief);
    });
    // What a snapshot follows is what one anew has, and no change changes nothing.
    test::expect_same(grid.snapshot(before), grid.snapshot());
    const std::string hash = grid.content_hash();
    ASSERT_EQ(grid.update_box(box, states), 0U);
    ASSERT_EQ(grid.content_hash(), hash);
  }
  EXPECT_EQ(rounds, 60U);
  EXPECT_GT(changes, 30'000U);
  EXPECT_GT(kept_beliefs, 1'000U);
  EXPECT_GT(lost_beliefs, 1'000U);
}

TEST(UpdateBox, WrongArgumentsChangeNothing) {
  BeliefGrid grid(kConfig);
  const std::string hash = grid.content_hash();
  const VoxelBox box = VoxelBox::from_dims(grid.min_index(), {2, 3, 4});
  test::expect_error(ErrorCode::invalid_argument,
                     "the array has 5 states, but the box has 24 voxels",
                     [&] { (void)grid.update_box(box, std::vector<std::uint8_t>(5, 1)); });
  std::vector<std::uint8_t> states(24, 1);
  states[7] = 9;
  test::expect_error(ErrorCode::invalid_argument, "the state at position 7 is 9; valid values:",
                     [&] { (void)grid.update_box(box, states); });
  states[7] = 1;
  VoxelBox beyond = box;
  beyond.min.x -= 1, beyond.max.x -= 1;
  test::expect_error(ErrorCode::invalid_argument, "not inside the workspace",
                     [&] { (void)grid.update_box(beyond, states); });
  EXPECT_EQ(grid.content_hash(), hash);
  EXPECT_EQ(grid.update_box({box.min, box.min}, {}), 0U);
}

}  // namespace
}  // namespace viewgain
