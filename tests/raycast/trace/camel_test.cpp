// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The camel's map: its size and counts, and its rays against the oracle.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "oracle/gain.hpp"
#include "raycast/scene_makers.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain {
namespace {

TEST(Camel, RaysOfCamel64AgreeWithTheOracleUnderEachInstructionSet) {
  const BeliefGrid grid = test::camel_grid(64);
  const oracle::DenseMap map(grid);
  const Sensor sensor = sensor_preset("sr4000");
  const oracle::RayLimits limits = oracle::limits_of(map, sensor, {});
  const std::vector<Pose> poses = sphere_poses(12, 0.6);
  std::vector<std::vector<RayHit>> expected;
  for (const Pose& pose : poses) expected.push_back(oracle::trace(map, sensor, {}, pose));
  for (const std::string& isa : available_isas()) {
    SCOPED_TRACE(isa);
    const test::ScopedIsa scoped(isa);
    const auto scene = VoxelScene::build(grid);
    const GainEvaluator tracer(scene, sensor, test::kPaper);
    std::size_t rays = 0;
    std::size_t same = 0;
    std::size_t ties = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::vector<RayHit> own = tracer.trace(poses[i]);
      const std::vector<oracle::Ray> view =
          oracle::view_rays(map.T_world_grid, map.voxel_size, sensor.camera, 1, poses[i]);
      ASSERT_EQ(own.size(), view.size());
      for (std::size_t k = 0; k < own.size(); ++k, ++rays) {
        if (oracle::same_ending(expected[i][k], own[k])) {
          ++same;
        } else if (oracle::is_tie(map, view[k], limits, own[k])) {
          ++ties;
        }
      }
      for (const Criterion criterion :
           {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
        const GainConfig config{
            .model = GainModel::paper, .criterion = criterion, .posterior_entropy = true};
        const ViewGain actual = GainEvaluator(scene, sensor, config).evaluate(poses[i]);
        const ViewGain by_oracle = oracle::gain_of_hits(grid, sensor, config, poses[i], own);
        EXPECT_NEAR(actual.gain, by_oracle.gain, 1e-6 * by_oracle.gain);
        EXPECT_NEAR(actual.refinement, by_oracle.refinement, 1e-6 * by_oracle.refinement);
        EXPECT_NEAR(actual.posterior_entropy, by_oracle.posterior_entropy,
                    1e-6 * std::abs(by_oracle.posterior_entropy));
      }
    }
    EXPECT_EQ(rays, poses.size() * 25'344U);
    EXPECT_EQ(same + ties, rays);
    EXPECT_GE(static_cast<double>(same), 0.9999 * static_cast<double>(rays));
    RecordProperty(isa + "_ties", std::to_string(ties));
  }
}

/// Positions in rising order.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = static_cast<double>(i);
  return result;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Eigen::Map<const Eigen::ArrayXd> x(a.data(), static_cast<Eigen::Index>(a.size()));
  const Eigen::Map<const Eigen::ArrayXd> y(b.data(), static_cast<Eigen::Index>(b.size()));
  const Eigen::ArrayXd dx = x - x.mean(), dy = y - y.mean();
  return (dx * dy).sum() / std::sqrt(dx.square().sum() * dy.square().sum());
}

TEST(Camel, GainsAreAboutTheSameAtScale1) {
  const auto views = test::camel_views();
  const BeliefGrid fine = test::camel_grid(192, views);
  const BeliefGrid coarse = test::camel_grid(192, views, {.coarsest = 1});
  std::uint64_t cells = 0, voxels = 0;
  coarse.for_each_belief(
      [&](Index3 v, const Belief&) { ++(coarse.scale(v) == 1 ? cells : voxels); });
  EXPECT_GT(cells, 10 * voxels);
  EXPECT_GT(cells, 1000U);
  const Sensor sensor = sensor_preset("sr4000");
  const std::vector<Pose> poses = sphere_poses(200, 0.6);
  int gains = 0;
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    const auto of = [&](const BeliefGrid& grid) {
      const GainEvaluator evaluator(VoxelScene::build(grid), sensor,
                                    {.model = model, .pixel_stride = 2});
      std::vector<double> values;
      for (const ViewGain& view : evaluator.evaluate(poses)) values.push_back(view.gain);
      return values;
    };
    const std::vector<double> a = of(fine), b = of(coarse);
    const double sum_a = std::accumulate(a.begin(), a.end(), 0.0),
                 sum_b = std::accumulate(b.begin(), b.end(), 0.0);
    EXPECT_NEAR(sum_b / sum_a, 1.0, 0.1) << static_cast<int>(model);
    EXPECT_GT(correlation(ranks(a), ranks(b)), 0.98) << static_cast<int>(model);
    ++gains;
  }
  EXPECT_EQ(gains, 3);
}

}  // namespace
}  // namespace viewgain
