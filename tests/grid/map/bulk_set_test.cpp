// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Many voxels at once, and visits of the occupied ones.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/voxel.hpp"

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
    test::expect_same(together.snapshot(before), together.snapshot());
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

// Boxes of voxels, and the way between voxels and the world.

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
  test::for_each_voxel(box, [&](Index3 voxel) {
    const Eigen::Vector3d in_grid = T_world_grid.inverse() * grid.center(voxel);
    ASSERT_NEAR(in_grid.x(), (voxel.x + 0.5) * V, 1e-12);
    ASSERT_NEAR(in_grid.y(), (voxel.y + 0.5) * V, 1e-12);
    ASSERT_NEAR(in_grid.z(), (voxel.z + 0.5) * V, 1e-12);
    ASSERT_EQ(snapshot.center(voxel), grid.center(voxel));
    const Eigen::Vector3d off(inside(random), inside(random), inside(random));
    const Eigen::Vector3d p = grid.center(voxel) + T_world_grid.rotation() * (V * off);
    ASSERT_EQ(grid.index_of(p), voxel);
    ASSERT_EQ(snapshot.index_of(p), voxel);
    ++voxels;
  });
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
