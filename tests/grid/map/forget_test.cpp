// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A part of a map made unknown again.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "core/expect_error.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// Over a border of OpenVDB's nodes of 128³ voxels, off the blocks' lattice.
const GridConfig kConfig{0.01, {{-0.13, 1.15, -0.05}, {0.06, 1.45, 0.15}}, {}, 0.01};

template <typename Visit>
void for_each_voxel(const BeliefGrid& grid, Visit&& visit) {
  const Index3 min = grid.min_index(), d = grid.dims();
  for (int x = min.x; x < min.x + d.x; ++x) {
    for (int y = min.y; y < min.y + d.y; ++y) {
      for (int z = min.z; z < min.z + d.z; ++z) visit(Index3{x, y, z});
    }
  }
}

/// All voxels free, as tiles where that is possible, but for some voxels of every other block.
BeliefGrid known_map(unsigned seed) {
  const BeliefGrid layout(kConfig);
  BeliefGrid grid =
      BeliefGrid::from_states(kConfig, std::vector<std::uint8_t>(layout.voxel_count(), 1));
  std::mt19937 random(seed);
  std::vector<BeliefGrid::VoxelValue> values;
  for_each_voxel(grid, [&](Index3 voxel) {
    const bool is_mixed = ((voxel.x >> 3) + (voxel.y >> 3) + (voxel.z >> 3)) % 2 == 0;
    if (!is_mixed || random() % 20 != 0) return;
    BeliefGrid::VoxelValue value{voxel, random() % 2 == 0 ? 1.0F : -1.0F, {}};
    if (random() % 2 == 0)
      value.belief = Belief{{1, 2, 3, 0, 0, 0}, {}, static_cast<std::uint32_t>(1 + random() % 9)};
    values.push_back(value);
  });
  grid.set(values);
  return grid;
}

Box random_region(std::mt19937& random, const Box& workspace) {
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  Box region;
  for (std::size_t k = 0; k < 3; ++k) {
    const double size = workspace.max[k] - workspace.min[k];
    const auto [low, high] = std::minmax({share(random), share(random)});
    region.min[k] = workspace.min[k] + low * size;
    region.max[k] = workspace.min[k] + high * size;
  }
  return region;
}

TEST(Forget, VoxelsWhoseCentresLieInTheRegionAreUnknownOthersAsBefore) {
  std::mt19937 random(3);
  std::uint64_t forgotten = 0, kept = 0, forgotten_beliefs = 0;
  for (unsigned round = 0; round < 30; ++round) {
    BeliefGrid grid = known_map(round);
    grid.append_view(Pose());
    for (int time = 0; time < 2; ++time) {  // the second over the first
      const BeliefGrid before = grid.clone();
      const Box region = random_region(random, grid.workspace());
      std::uint64_t expected = 0;
      const std::uint64_t found = grid.forget(region);
      for_each_voxel(grid, [&](Index3 voxel) {
        const Eigen::Vector3d p = grid.center(voxel);
        if (region.contains(p.x(), p.y(), p.z())) {
          expected += before.state(voxel) != VoxelState::unknown ? 1U : 0U;
          forgotten_beliefs += before.belief(voxel) ? 1U : 0U;
          ASSERT_EQ(grid.state(voxel), VoxelState::unknown);
          ASSERT_FALSE(grid.log_odds(voxel) || grid.belief(voxel));
        } else {
          ASSERT_EQ(grid.log_odds(voxel), before.log_odds(voxel));
          ASSERT_EQ(grid.belief(voxel), before.belief(voxel));
          ++kept;
        }
      });
      ASSERT_EQ(found, expected);
      forgotten += found;
      ASSERT_EQ(grid.views().size(), 1U);
      // What a snapshot follows is what one anew has.
      const GridSnapshot anew = grid.snapshot(), followed = grid.snapshot(before.snapshot());
      ASSERT_EQ(followed.leaves.size(), anew.leaves.size());
      ASSERT_EQ(followed.tiles, anew.tiles);
      for (std::size_t i = 0; i < anew.leaves.size(); ++i) {
        ASSERT_EQ(followed.leaves[i].origin, anew.leaves[i].origin);
        ASSERT_EQ(followed.leaves[i].non_free, anew.leaves[i].non_free);
        ASSERT_EQ(followed.leaves[i].occupied, anew.leaves[i].occupied);
      }
      ASSERT_EQ(grid.forget(region), 0U);
      ASSERT_EQ(grid.statistics().unknown,
                grid.voxel_count() - grid.statistics().free - grid.statistics().occupied);
    }
  }
  EXPECT_GT(forgotten, 30U * 1000);
  EXPECT_GT(kept, 30U * 5000);
  EXPECT_GT(forgotten_beliefs, 100U);
}

TEST(Forget, EverywhereLeavesAnEmptyMap) {
  BeliefGrid grid = known_map(7);
  const std::uint64_t bytes = grid.statistics().bytes;
  EXPECT_EQ(grid.forget({{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}}), grid.voxel_count());
  EXPECT_EQ(grid.content_hash(), BeliefGrid(kConfig).content_hash());
  grid.for_each_belief([](Index3 voxel, const Belief&) { FAIL() << voxel.x; });
  EXPECT_LT(grid.statistics().bytes, bytes);
}

TEST(Forget, NothingIsForgottenOfARegionWithoutVoxels) {
  BeliefGrid grid = known_map(8);
  const std::string hash = grid.content_hash();
  for (const Box& region : {Box{{5, 5, 5}, {6, 6, 6}}, Box{{0, 1.2, 0}, {0, 1.3, 0.1}},
                            Box{{0.04, 1.4, 0.1}, {-0.1, 1.2, -0.02}},
                            Box{{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}}}) {
    EXPECT_EQ(grid.forget(region), 0U);
  }
  EXPECT_EQ(grid.content_hash(), hash);
  test::expect_error(ErrorCode::invalid_argument, "y is not a number", [&] {
    grid.forget({{0, std::numeric_limits<double>::quiet_NaN(), 0}, {1, 1, 1}});
  });
  EXPECT_EQ(grid.content_hash(), hash);
}

TEST(Forget, ARoomOfTenMillionVoxelsIsTilesAgain) {
  const GridConfig config{0.01, {{0, 0, 0}, {2.56, 2.56, 2.56}}, {}, 0.01};
  BeliefGrid grid =
      BeliefGrid::from_states(config, std::vector<std::uint8_t>(std::size_t{256} * 256 * 256, 1));
  EXPECT_EQ(grid.forget({{0, 0, 0}, {2.56, 2.56, 1.28}}), std::uint64_t{256} * 256 * 128);
  EXPECT_TRUE(grid.snapshot().leaves.empty());
  EXPECT_EQ(grid.statistics().unknown, std::uint64_t{256} * 256 * 128);
}

}  // namespace
}  // namespace viewgain
