// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Known surface nearer than the sensor can measure: it is not measured, and not seen through.
#include <gtest/gtest.h>

#include <cmath>

#include "raycast/scene_makers.hpp"
#include "viewgain/raycast/view_measure.hpp"
#include "viewgain/raycast/view_selection.hpp"

namespace viewgain {
namespace {

using test::kExactVoxel;

constexpr Index3 kDims{48, 40, 40};
constexpr int kWall = 12;           // its plane of voxels
constexpr double kMinRange = 17.5;  // of the sensor [voxels]
constexpr double kEyeX = -2;        // of the camera [voxels]

/// Free up to a wall, which leaves `open` rows of voxels at the lower y; behind it free space, then
/// surface and unknown space. `hidden`: unknown voxels stand before the wall.
BeliefGrid room(int open, bool hidden, bool with_wall = true) {
  std::vector<std::uint8_t> states;
  for (int x = 0; x < kDims.x; ++x) {
    for (int y = 0; y < kDims.y; ++y) {
      for (int z = 0; z < kDims.z; ++z) {
        VoxelState state = x < 30 ? VoxelState::free : VoxelState::unknown;
        if (x == 30 && z % 3 == 0) state = VoxelState::occupied;
        if (y >= open && x == kWall && with_wall) state = VoxelState::occupied;
        if (hidden && x == kWall - 3) state = VoxelState::unknown;
        states.push_back(static_cast<std::uint8_t>(state));
      }
    }
  }
  GridConfig config;
  config.voxel_size = kExactVoxel;
  config.workspace = test::sparse_map(kDims, {}).workspace();
  config.prior_sigma = 0.5 * kExactVoxel;
  return BeliefGrid::from_states(config, states);
}

Sensor sensor() {
  Sensor sensor = test::lattice_sensor(61, 53);
  sensor.camera.fx = sensor.camera.fy = 60;
  sensor.min_range = kMinRange * kExactVoxel;
  sensor.working_distance = 30 * kExactVoxel;
  return sensor;
}
// All rays come to the wall before min_range.
Pose before_wall() { return test::axis_pose({kEyeX, 20.3, 20.6}, 0, true); }

struct Counts : ViewMeasure, RunMeasure {
  double measure(const Pose&, std::span<const ViewMeasure::Hit> hits) const override {
    return static_cast<double>(hits.size());
  }
  double measure(const Pose&, std::span<const RunMeasure::Run> runs) const override {
    return static_cast<double>(runs.size());
  }
};

class NearWall : public testing::TestWithParam<std::tuple<GainModel, ExecConfig::Tracer>> {
 protected:
  GainEvaluator evaluator(const BeliefGrid& grid, GainConfig config = {}, int threads = 1,
                          const Obstacles& obstacles = {}) {
    config.model = std::get<0>(GetParam());
    return {
        VoxelScene::build(grid, {obstacles}), sensor(), config, {threads, std::get<1>(GetParam())}};
  }
};

TEST_P(NearWall, LeavesNothingToGain) {
  const std::vector<Pose> poses(3, before_wall());
  for (const bool hidden : {false, true}) {
    const BeliefGrid grid = room(0, hidden);
    const Obstacles far{{Box{{0.5, 0.5, 0.5}, {0.6, 0.6, 0.6}}}, {}};
    for (const Obstacles& obstacles : {Obstacles{}, far}) {
      for (const int threads : {1, 3}) {
        const GainEvaluator own = evaluator(grid, {}, threads, obstacles);
        const ViewGain one = own.evaluate(poses[0]);
        EXPECT_EQ(one.status, ViewGain::Status::ok);
        EXPECT_EQ(one.gain, 0);
        EXPECT_EQ(one.hits, 0U);
        for (const ViewGain& gain : own.evaluate(poses)) EXPECT_EQ(gain.gain, 0);
        std::vector<ApproximateGain> about(poses.size());
        own.approximate(poses, about);
        for (const ApproximateGain& gain : about) EXPECT_EQ(gain.gain, 0);
        EXPECT_TRUE(own.contributions(poses[0]).empty());
        EXPECT_EQ(own.best_set(poses, 2).gain, 0);
        const Counts counts;
        std::vector<double> results(poses.size(), 1);
        own.evaluate(poses, results, static_cast<const ViewMeasure&>(counts));
        EXPECT_EQ(results, std::vector<double>(poses.size(), 0));
        own.evaluate(poses, results, static_cast<const RunMeasure&>(counts));
        EXPECT_EQ(results, std::vector<double>(poses.size(), 0));
        const GainEvaluator::RayOutcomes outcomes = own.outcomes(poses[0]);
        EXPECT_EQ(outcomes.too_near, outcomes.rays);
        for (const RayHit& hit : own.trace(poses[0])) {
          ASSERT_EQ(hit.kind, RayHit::Kind::obstacle);
          EXPECT_LT(hit.range, kMinRange * kExactVoxel);
          EXPECT_GE(hit.range, (kWall - kEyeX) * kExactVoxel * (1 - 1e-6));
        }
      }
    }
  }
}

TEST_P(NearWall, IsSurfaceLikeAnyOtherWhereItCanBeMeasured) {
  const BeliefGrid grid = room(0, false);
  const ViewGain near = evaluator(grid, {.min_range = 13.9 * kExactVoxel}).evaluate(before_wall());
  const ViewGain none = evaluator(room(0, false, false)).evaluate(before_wall());
  EXPECT_EQ(near.hits, near.rays);
  EXPECT_GT(none.gain, 0);
}

// Rays that pass beside it see what they saw; the wall takes the others as an obstacle does.
TEST_P(NearWall, TakesWhatAnObstacleInItsPlaceTakes) {
  const BeliefGrid walled = room(20, false), open = room(20, false, false);
  const double x = kWall * kExactVoxel, y = 20 * kExactVoxel;
  const Obstacles box{{Box{{x, y, 0}, {x + kExactVoxel, 1, 1}}}, {}};
  const Pose pose = look_at(kExactVoxel * Eigen::Vector3d(kEyeX, 20.3, 20.6),
                            kExactVoxel * Eigen::Vector3d(30, 16.2, 21), {0.1, 0.2, 1});
  const GainEvaluator own = evaluator(walled), other = evaluator(open, {}, 1, box);
  const std::vector<RayHit> hits = own.trace(pose), expected = other.trace(pose);
  std::size_t blocked = 0, seen = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ASSERT_EQ(hits[i].kind, expected[i].kind) << i;
    EXPECT_EQ(hits[i].voxel, expected[i].voxel);
    if (hits[i].kind == RayHit::Kind::none) continue;
    EXPECT_NEAR(hits[i].range, expected[i].range, 1e-5);
    ++(hits[i].kind == RayHit::Kind::obstacle ? blocked : seen);
  }
  EXPECT_GT(blocked, 500U);
  EXPECT_GT(seen, 500U);
  const ViewGain gain = own.evaluate(pose);
  EXPECT_GT(gain.gain, 0);
  if (std::get<0>(GetParam()) == GainModel::paper) {
    EXPECT_EQ(gain.hits, seen);
    EXPECT_EQ(gain.gain, other.evaluate(pose).gain);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Gains, NearWall,
    testing::Combine(testing::Values(GainModel::paper, GainModel::surface, GainModel::combined),
                     testing::ValuesIn(test::kTracers)),
    [](const auto& gain) {
      return std::string(gain_model_name(std::get<0>(gain.param))) +
             (std::get<1>(gain.param) == ExecConfig::Tracer::sweep ? "_sweep" : "_embree");
    });

}  // namespace
}  // namespace viewgain
