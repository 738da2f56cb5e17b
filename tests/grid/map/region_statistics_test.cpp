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

#include "core/expect_error.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {
using Statistics = BeliefGrid::Statistics;

/// A map of 21 x 18 x 25 voxels off the origin in all three states, some with beliefs.
BeliefGrid random_map(std::mt19937_64& random) {
  const GridConfig config{0.01, {{-0.05, 0.03, -0.11}, {0.16, 0.21, 0.14}}, {}, 0.02};
  BeliefGrid grid(config);
  const Index3 min = grid.min_index(), dims = grid.dims();
  std::uniform_real_distribution<double> unit(0, 1);
  for (int x = 0; x < dims.x; ++x) {
    for (int y = 0; y < dims.y; ++y) {
      for (int z = 0; z < dims.z; ++z) {
        const Index3 voxel{min.x + x, min.y + y, min.z + z};
        if (x < 8 || unit(random) < 0.3) continue;  // unknown, whole leaves of it too
        const bool occupied = unit(random) < 0.3;
        std::optional<Belief> belief;
        if (unit(random) < 0.5) {
          const auto diagonal = [&] { return static_cast<float>(1e4 + 1e5 * unit(random)); };
          belief = Belief{{diagonal(), diagonal(), diagonal(), 3e3F, -2e3F, 1e3F},
                          {},
                          1 + static_cast<std::uint32_t>(9 * unit(random))};
        }
        grid.set(voxel, occupied ? 0.85F : -0.4F, belief);
      }
    }
  }
  return grid;
}

/// Voxel by voxel, by the definition, and the mean sigma.
std::pair<Statistics, double> slow_statistics(const BeliefGrid& grid, const Box& region,
                                              Criterion criterion) {
  const Index3 min = grid.min_index(), dims = grid.dims();
  const double V = grid.voxel_size();
  const SymmetricMatrix3 prior = SymmetricMatrix3::identity(std::pow(grid.prior_sigma(), -2));
  Statistics result;
  double sum = 0;
  int believed = 0;
  for (int x = min.x; x < min.x + dims.x; ++x) {
    for (int y = min.y; y < min.y + dims.y; ++y) {
      for (int z = min.z; z < min.z + dims.z; ++z) {
        if (!region.contains((x + 0.5) * V, (y + 0.5) * V, (z + 0.5) * V)) continue;
        const VoxelState state = grid.state({x, y, z});
        (state == VoxelState::unknown ? result.unknown
         : state == VoxelState::free  ? result.free
                                      : result.occupied) += 1;
        const auto belief = grid.belief({x, y, z});
        if (!belief) continue;
        result.hits += belief->hits;
        if (state != VoxelState::occupied) continue;
        const SymmetricMatrix3 information = belief->information_matrix();
        result.entropy_removed +=
            entropy(prior, criterion) - entropy(prior + information, criterion);
        const Eigen::Matrix3d covariance =
            information.matrix().inverse() + V * V / 12 * Eigen::Matrix3d::Identity();
        sum += std::sqrt(covariance.trace() / 3);
        ++believed;
      }
    }
  }
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

}  // namespace
}  // namespace viewgain
