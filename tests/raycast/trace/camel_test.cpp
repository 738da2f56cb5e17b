// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The camel's map: its size and counts, and its rays against the oracle.
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace viewgain
