// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Rays and gains of random maps against the double-precision oracle, under each instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "oracle/gain.hpp"
#include "oracle_tally.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using test::MapFamily;

constexpr int kMaps = test::kSlowBuild ? 6 : 40;
constexpr std::size_t kPosesPerMap = test::kSlowBuild ? 3 : 5;
constexpr std::size_t kRaysPerPose = 25 * 19;
constexpr std::array kCriteria{Criterion::log_diagonal, Criterion::log_determinant,
                               Criterion::trace};

/// |a - b| as a share of |b|; 0 if both are 0.
double relative_error(double a, double b) {
  return a == b ? 0.0 : std::abs(a - b) / std::max(std::abs(b), 1e-300);
}

class TraceOracle : public testing::TestWithParam<MapFamily> {
 protected:
  void compare_gains(const BeliefGrid& grid, const std::shared_ptr<const VoxelScene>& scene,
                     const Sensor& sensor, const Pose& pose, const std::vector<RayHit>& expected,
                     const std::vector<RayHit>& own, std::size_t different,
                     const ExecConfig& exec) {
    for (const Criterion criterion : kCriteria) {
      SCOPED_TRACE(criterion_name(criterion));
      const GainConfig config{
          .model = GainModel::paper, .criterion = criterion, .posterior_entropy = true};
      const GainEvaluator evaluator(scene, sensor, config, exec);
      const ViewGain actual = evaluator.evaluate(pose);
      const ViewGain by_own = oracle::gain_of_hits(grid, sensor, config, pose, own);
      ASSERT_EQ(actual.status, by_own.status);
      ++gain_checks_;
      if (actual.status != ViewGain::Status::ok) {
        EXPECT_EQ(actual.gain, 0.0);
        continue;
      }
      EXPECT_LE(relative_error(actual.gain, by_own.gain), 1e-6);
      EXPECT_LE(relative_error(actual.exploration, by_own.exploration), 1e-6);
      EXPECT_LE(relative_error(actual.refinement, by_own.refinement), 1e-6);
      EXPECT_LE(relative_error(actual.posterior_entropy, by_own.posterior_entropy), 1e-6);
      EXPECT_EQ(actual.rays, by_own.rays);
      EXPECT_EQ(actual.hits, by_own.hits);
      EXPECT_EQ(actual.unknown_voxels, by_own.unknown_voxels);
      EXPECT_EQ(actual.occupied_voxels, by_own.occupied_voxels);

      const ViewGain by_oracle = oracle::gain_of_hits(grid, sensor, config, pose, expected);
      const double one_hit =
          std::max(oracle::largest_one_hit_gain(grid, sensor, config, pose, expected),
                   oracle::largest_one_hit_gain(grid, sensor, config, pose, own));
      EXPECT_LE(std::abs(actual.gain - by_oracle.gain),
                static_cast<double>(different) * one_hit + 1e-5 * by_oracle.gain);
    }
  }

  std::size_t gain_checks_ = 0;
};

TEST_P(TraceOracle, AgreesUnderEachInstructionSet) {
  test::Random random(1234 + static_cast<unsigned>(GetParam()));
  const std::vector<std::string> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  std::map<std::pair<std::string, ExecConfig::Tracer>, test::OracleTally> tallies;
  for (int i = 0; i < kMaps; ++i) {
    const test::RandomMap made = test::random_map(GetParam(), random);
    const oracle::DenseMap map(made.grid);
    const Sensor sensor = test::random_sensor(made.grid, random);
    const std::vector<Pose> poses = test::random_poses(made, kPosesPerMap, random);
    std::vector<std::vector<RayHit>> expected;
    for (const Pose& pose : poses) expected.push_back(oracle::trace(map, sensor, {}, pose));

    for (const std::string& isa : isas) {
      SCOPED_TRACE("map " + std::to_string(i) + ", " + isa);
      const test::ScopedIsa scoped(isa);
      const auto scene = VoxelScene::build(made.grid, {}, {.num_threads = 1});
      ASSERT_EQ(scene->isa(), isa);
      for (const ExecConfig::Tracer tracer : test::kTracers) {
        const ExecConfig exec{1, tracer};
        const GainEvaluator evaluator(scene, sensor, test::kPaper, exec);
        test::OracleTally& tally = tallies[{isa, tracer}];
        for (std::size_t k = 0; k < poses.size(); ++k) {
          const std::vector<RayHit> own = evaluator.trace(poses[k]);
          const std::size_t different = tally.add(map, sensor, poses[k], expected[k], own);
          if (k != static_cast<std::size_t>(i) % poses.size()) continue;
          compare_gains(made.grid, scene, sensor, poses[k], expected[k], own, different, exec);
        }
      }
    }
  }

  EXPECT_EQ(tallies.size(), isas.size() * test::kTracers.size());
  EXPECT_EQ(gain_checks_, kMaps * kCriteria.size() * tallies.size());
  for (const auto& [isa_and_tracer, tally] : tallies) {
    EXPECT_EQ(tally.rays, kMaps * kPosesPerMap * kRaysPerPose) << isa_and_tracer.first;
    EXPECT_TRUE(tally.agrees(1)) << isa_and_tracer.first;
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, TraceOracle, testing::ValuesIn(test::kMapFamilies),
                         test::family_name);

}  // namespace
}  // namespace viewgain
