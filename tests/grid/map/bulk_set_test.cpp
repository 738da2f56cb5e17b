// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Many voxels at once, and visits of the occupied ones.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "core/expect_error.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {
using VoxelValue = BeliefGrid::VoxelValue;

using test::expect_error;

const GridConfig kConfig{0.01, {{-0.13, -0.11, -0.2}, {0.15, 0.1, 1.4}}, {}, 0.01};

/// Random voxels, some more than once, half of them with a belief.
std::vector<VoxelValue> random_values(const BeliefGrid& grid, int count, unsigned seed) {
  std::mt19937 random(seed);
  const Index3 min = grid.min_index(), d = grid.dims();
  std::uniform_int_distribution<int> x(0, d.x - 1), y(0, d.y - 1), z(0, d.z - 1), steps(-40, 70);
  std::vector<VoxelValue> values;
  for (int i = 0; i < count; ++i) {
    VoxelValue value{{min.x + x(random), min.y + y(random), min.z + z(random)},
                     static_cast<float>(0.05 * steps(random))};
    if (i % 7 == 6) value.voxel = values[values.size() / 2].voxel;
    if (random() % 2 == 0) {
      value.belief = Belief{{1, 2, 3, 0, 0, 0}, {0, 0, 0.01F}, static_cast<std::uint32_t>(i)};
    }
    values.push_back(value);
  }
  return values;
}

TEST(BulkSet, IsAsOneByOneInTheirOrder) {
  BeliefGrid together(kConfig), alone(kConfig);
  int repeated = 0;
  for (unsigned round = 0; round < 3; ++round) {  // over what is there, too
    const std::vector<VoxelValue> values = random_values(together, 4000, round);
    const GridSnapshot before = together.snapshot();
    together.set(values);
    std::map<std::tuple<int, int, int>, VoxelValue> last;
    for (const VoxelValue& value : values) {
      alone.set(value.voxel, value.log_odds, value.belief);
      last[{value.voxel.x, value.voxel.y, value.voxel.z}] = value;
    }
    repeated += static_cast<int>(values.size() - last.size());
    ASSERT_EQ(together.content_hash(), alone.content_hash());
    for (const auto& [at, value] : last) {
      ASSERT_EQ(together.belief(value.voxel), value.belief);
      ASSERT_EQ(together.log_odds(value.voxel), value.log_odds);
    }
    // The snapshot before counts no longer where voxels were set.
    const GridSnapshot updated = together.snapshot(before), anew = together.snapshot();
    ASSERT_EQ(updated.leaves.size(), anew.leaves.size());
    for (std::size_t i = 0; i < anew.leaves.size(); ++i) {
      ASSERT_EQ(updated.leaves[i].non_free, anew.leaves[i].non_free);
      ASSERT_EQ(updated.leaves[i].beliefs, anew.leaves[i].beliefs);
    }
  }
  EXPECT_GT(repeated, 1500);
  together.set(std::span<const VoxelValue>{});
  EXPECT_EQ(together.content_hash(), alone.content_hash());
}

TEST(BulkSet, AllOrNone) {
  BeliefGrid grid(kConfig);
  grid.set(random_values(grid, 500, 9));
  const std::string before = grid.content_hash();
  const Belief no_matrix{{1, 1, -1, 0, 0, 0}, {}, 1};
  for (const auto& [part, bad] : {std::pair<const char*, VoxelValue>{"outside", {{99, 0, 0}, 1.0F}},
                                  {"NaN", {{1, 2, 3}, std::nanf("")}},
                                  {"-1", {{1, 2, 3}, 1.0F, no_matrix}}}) {
    std::vector<VoxelValue> values = random_values(grid, 500, 10);
    values.push_back(bad);
    expect_error(ErrorCode::invalid_argument, part, [&] { grid.set(values); });
    EXPECT_EQ(grid.content_hash(), before) << part;
    values.pop_back();
    BeliefGrid good = grid.clone();
    good.set(values);
    EXPECT_NE(good.content_hash(), before) << part;
  }
}

TEST(ForEachOccupied, VisitsEachOnceInAnOrderOfItsOwn) {
  BeliefGrid grid(kConfig);
  grid.set(random_values(grid, 6000, 3));
  std::vector<Index3> visited;
  std::size_t with_belief = 0;
  grid.for_each_occupied([&](const VoxelValue& v) {
    visited.push_back(v.voxel);
    ASSERT_EQ(grid.state(v.voxel), VoxelState::occupied);
    ASSERT_EQ(grid.log_odds(v.voxel), v.log_odds);
    const std::optional<Belief> belief = grid.belief(v.voxel);
    ASSERT_EQ(belief.has_value(), v.belief.has_value());
    if (belief) {
      ASSERT_EQ(*belief, *v.belief);
    }
    with_belief += v.belief.has_value();
  });
  EXPECT_EQ(visited.size(), grid.statistics().occupied);
  EXPECT_GT(visited.size(), 2000U);
  EXPECT_GT(with_belief, 1000U);
  EXPECT_LT(with_belief, visited.size());

  // Leaves as the snapshot lists them, z fastest within: each voxel once, so.
  std::vector<Index3> expected;
  for (const GridSnapshot::Leaf& leaf : grid.snapshot().leaves) {
    for (int i = 0; i < 512; ++i) {
      const Index3 v{leaf.origin.x + i / 64, leaf.origin.y + i / 8 % 8, leaf.origin.z + i % 8};
      if (grid.state(v) == VoxelState::occupied) expected.push_back(v);
    }
  }
  EXPECT_EQ(visited, expected);

  // The same order however the map came about.
  BeliefGrid other(kConfig);
  std::vector<VoxelValue> values;
  const Index3 min = grid.min_index(), d = grid.dims();
  for (int z = min.z + d.z - 1; z >= min.z; --z) {
    for (int y = min.y; y < min.y + d.y; ++y) {
      for (int x = min.x; x < min.x + d.x; ++x) {
        const auto log_odds = grid.log_odds({x, y, z});
        if (log_odds) values.push_back({{x, y, z}, *log_odds, grid.belief({x, y, z})});
      }
    }
  }
  other.set(values);
  ASSERT_EQ(other.content_hash(), grid.content_hash());
  std::vector<Index3> again;
  other.for_each_occupied([&](const VoxelValue& v) { again.push_back(v.voxel); });
  EXPECT_EQ(again, visited);
}

}  // namespace
}  // namespace viewgain
