// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {

using test::for_each_voxel;
using Statistics = BeliefGrid::Statistics;

/// A map of 21 x 18 x 25 voxels off the origin in all three states, some with beliefs.
BeliefGrid random_map(std::mt19937_64& random) {
  const GridConfig config{0.01, {{-0.05, 0.03, -0.11}, {0.16, 0.21, 0.14}}, {}, 0.02};
  BeliefGrid grid(config);
  std::uniform_real_distribution<double> unit(0, 1);
  for_each_voxel(grid, [&](Index3 voxel) {
    // Unknown, whole leaves of it too.
    if (voxel.x < grid.min_index().x + 8 || unit(random) < 0.3) return;
    const bool occupied = unit(random) < 0.3;
    std::optional<Belief> belief;
    if (unit(random) < 0.5) {
      const auto diagonal = [&] { return static_cast<float>(1e4 + 1e5 * unit(random)); };
      belief = Belief{{diagonal(), diagonal(), diagonal(), 3e3F, -2e3F, 1e3F},
                      {},
                      1 + static_cast<std::uint32_t>(9 * unit(random))};
    }
    grid.set(voxel, occupied ? 0.85F : -0.4F, belief);
  });
  return grid;
}

/// Voxel by voxel, by the definition, and the mean sigma.
std::pair<Statistics, double> slow_statistics(const BeliefGrid& grid, const Box& region,
                                              Criterion criterion) {
  const double V = grid.voxel_size();
  const SymmetricMatrix3 prior = SymmetricMatrix3::identity(std::pow(grid.prior_sigma(), -2));
  Statistics result;
  double sum = 0;
  int believed = 0;
  for_each_voxel(grid, [&](Index3 voxel) {
    const Eigen::Vector3d p = V * (Eigen::Vector3d(voxel.x, voxel.y, voxel.z).array() + 0.5);
    if (!region.contains(p.x(), p.y(), p.z())) return;
    const VoxelState state = grid.state(voxel);
    (state == VoxelState::unknown ? result.unknown
     : state == VoxelState::free  ? result.free
                                  : result.occupied) += 1;
    const auto belief = grid.belief(voxel);
    if (!belief) return;
    result.hits += belief->hits;
    if (state != VoxelState::occupied) return;
    const SymmetricMatrix3 information = belief->information_matrix();
    result.entropy_removed += entropy(prior, criterion) - entropy(prior + information, criterion);
    const Eigen::Matrix3d covariance =
        information.matrix().inverse() + V * V / 12 * Eigen::Matrix3d::Identity();
    sum += std::sqrt(covariance.trace() / 3);
    ++believed;
  });
  return {result, sum / believed};
}

void expect_equal(const Statistics& a, const Statistics& b) {
  EXPECT_EQ(a.unknown, b.unknown);
  EXPECT_EQ(a.free, b.free);
  EXPECT_EQ(a.occupied, b.occupied);
  EXPECT_EQ(a.hits, b.hits);
  EXPECT_NEAR(a.entropy_removed, b.entropy_removed, 1e-9 * (1e-6 + b.entropy_removed));
}

void expect_sigma(double a, double b) {
  EXPECT_EQ(std::isnan(a), std::isnan(b));
  if (!std::isnan(b)) {
    EXPECT_NEAR(a, b, 1e-9 * b);
  }
}

TEST(RegionStatistics, AreTheSumsOverTheVoxels) {
  std::mt19937_64 random(4);
  const BeliefGrid grid = random_map(random);
  std::uniform_real_distribution<double> place(-0.13, 0.24);
  int with_points = 0;
  for (int i = 0; i < 120; ++i) {
    Box region;
    for (std::size_t k = 0; k < 3; ++k) {
      const double a = place(random), b = place(random);
      region.min[k] = std::min(a, b);
      region.max[k] = std::max(a, b);
    }
    const auto criterion = static_cast<Criterion>(i % 3);
    const auto [expected, sigma] = slow_statistics(grid, region, criterion);
    expect_equal(grid.statistics(region, criterion), expected);
    expect_sigma(grid.mean_sigma(region), sigma);
    with_points += expected.entropy_removed > 0 ? 1 : 0;
  }
  EXPECT_GT(with_points, 40);
}

TEST(RegionStatistics, BoundsMayBeInfiniteButNotNaN) {
  std::mt19937_64 random(6);
  const BeliefGrid grid = random_map(random);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Box everywhere{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  expect_equal(grid.statistics(everywhere), grid.statistics(grid.workspace()));
  const auto [expected, sigma] = slow_statistics(grid, everywhere, Criterion::log_diagonal);
  expect_equal(grid.statistics(), expected);
  expect_sigma(grid.mean_sigma(everywhere), sigma);
  for (std::size_t bound = 0; bound < 6; ++bound) {
    Box region = grid.workspace();
    (bound < 3 ? region.min : region.max)[bound % 3] = std::nan("");
    test::expect_error(ErrorCode::invalid_argument, std::string("along ") + "xyz"[bound % 3],
                       [&] { (void)grid.statistics(region); });
    EXPECT_THROW((void)grid.mean_sigma(region), Error);
  }
}

TEST(RegionStatistics, NothingThere) {
  std::mt19937_64 random(6);
  const BeliefGrid grid = random_map(random);
  const Box far{{1, 1, 1}, {2, 2, 2}};
  const Statistics outside = grid.statistics(far);
  EXPECT_EQ(outside.unknown + outside.free + outside.occupied + outside.hits, 0U);
  EXPECT_EQ(outside.entropy_removed, 0);
  EXPECT_TRUE(std::isnan(grid.mean_sigma(far)));
  const BeliefGrid unknown(GridConfig{0.01, {{0, 0, 0}, {3, 3, 3}}, {}, 0.01});
  const Statistics part = unknown.statistics(Box{{1, 1, 1}, {2, 2.1, 9}});
  EXPECT_EQ(part.unknown, 100U * 110 * 200);
  EXPECT_EQ(part.free + part.occupied, 0U);
}

// A part of a map made unknown again.

constexpr double kInf = std::numeric_limits<double>::infinity();

// Over a border of OpenVDB's nodes of 128³ voxels, off the blocks' lattice.
const GridConfig kConfig{0.01, {{-0.13, 1.15, -0.05}, {0.06, 1.45, 0.15}}, {}, 0.01};

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
      const GridSnapshot seen = grid.snapshot();
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
      test::expect_same(grid.snapshot(seen), grid.snapshot());
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
  for (const Box& region : {Box{{5, 5, 5}, {6, 6, 6}}, Box{{0, 1.2, 0}, {0, 1.3, 0.1}}}) {
    EXPECT_EQ(grid.forget(region), 0U);
  }
  for (const Box& region : {Box{{0.04, 1.4, 0.1}, {-0.1, 1.2, -0.02}},
                            Box{{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}}}) {
    test::expect_error(ErrorCode::invalid_argument, "inside out along x",
                       [&] { grid.forget(region); });
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
