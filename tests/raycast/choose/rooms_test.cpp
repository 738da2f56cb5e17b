// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Choosing where voxels are large in the image: race() and approximate() in a room, against scoring
// all.
#include <gtest/gtest.h>

#include <cmath>

#include "support/room_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {
namespace {

// A Kinect with a quarter of its pixels along each edge.
Sensor small_kinect() {
  Sensor sensor = sensor_preset("kinect_v1");
  sensor.camera = {.width = 160, .height = 120, .fx = 146, .fy = 146, .cx = 79.6, .cy = 59.7};
  return sensor;
}

std::shared_ptr<const VoxelScene> room() {
  static const auto scene = VoxelScene::build(test::room_grid(0.04, small_kinect(), 6));
  return scene;
}

TEST(ChoosingInARoom, RaceFindsTheBest) {
  const GainEvaluator evaluator(room(), small_kinect(), {.model = GainModel::paper});
  std::size_t right = 0, cases = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed, ++cases) {
    const std::vector<Pose> poses = test::poses_in(room()->snapshot(), 100, seed);
    const std::vector<ViewGain> all = evaluator.evaluate(poses);
    const BestViews raced = evaluator.race(poses, 1, {.seed = seed});
    const std::size_t best = best_indices(all, 1).at(0);
    ASSERT_GT(all[best].gain, 0);
    right += raced.indices.at(0) == best ? 1U : 0U;
    EXPECT_GE(raced.gains.at(0).gain, 0.98 * all[best].gain);
    EXPECT_EQ(raced.gains[0].gain, all[raced.indices[0]].gain);
    EXPECT_LT(raced.rays_traced, poses.size() * evaluator.rays_per_pose() / 3);
  }
  EXPECT_EQ(cases, 10U);
  EXPECT_GE(right, 9U);
}

class ApproximateInARoom : public testing::TestWithParam<GainModel> {};

TEST_P(ApproximateInARoom, StandardErrorsCoverTheTruth) {
  const GainEvaluator evaluator(room(), small_kinect(), {.model = GetParam()});
  const std::vector<Pose> poses = test::poses_in(room()->snapshot(), 300, 3);
  const std::vector<ViewGain> truth = evaluator.evaluate(poses);
  for (const double share : {0.02, 0.1, 0.5}) {
    std::size_t within = 0, count = 0;
    double sum = 0, true_sum = 0;
    // Poses share a lattice, which may suit a room's walls or not: over some lattices.
    for (std::uint64_t seed = 2; seed <= 5; ++seed) {
      std::vector<ApproximateGain> estimates(poses.size());
      ASSERT_EQ(evaluator.approximate(poses, estimates, {.share = share, .seed = seed}),
                poses.size());
      for (std::size_t i = 0; i < poses.size(); ++i, ++count) {
        const double off = std::abs(estimates[i].gain - truth[i].gain);
        within += off <= 2 * estimates[i].standard_error ? 1U : 0U;
        sum += estimates[i].gain, true_sum += truth[i].gain;
      }
    }
    const double part = static_cast<double>(within) / static_cast<double>(count);
    EXPECT_GE(part, 0.9) << share;
    EXPECT_LE(part, 0.99) << share;
    EXPECT_NEAR(sum, true_sum, 0.08 * true_sum) << share;
  }
}

TEST_P(ApproximateInARoom, AllRaysAreTheGainItself) {
  const GainEvaluator evaluator(room(), small_kinect(), {.model = GetParam()});
  std::vector<Pose> poses = test::poses_in(room()->snapshot(), 20, 4);
  poses[3].m[0] = std::nan("");
  const std::vector<ViewGain> truth = evaluator.evaluate(poses);
  std::vector<ApproximateGain> estimates(poses.size());
  evaluator.approximate(poses, estimates, {.share = 1});
  std::size_t cases = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i == 3) {
      EXPECT_TRUE(std::isnan(estimates[i].gain) && std::isnan(estimates[i].standard_error));
      continue;
    }
    EXPECT_EQ(estimates[i].gain, truth[i].gain);
    EXPECT_EQ(estimates[i].standard_error, 0);
    ++cases;
  }
  EXPECT_EQ(cases, 19U);
}

TEST_P(ApproximateInARoom, APoseDoesNotKnowOfOthersNorOfThreads) {
  const GainEvaluator one(room(), small_kinect(), {.model = GetParam()}, {.num_threads = 1});
  const GainEvaluator three(room(), small_kinect(), {.model = GetParam()}, {.num_threads = 3});
  const std::vector<Pose> poses = test::poses_in(room()->snapshot(), 30, 6);
  std::vector<ApproximateGain> all(30), threads(30), other(30), single(1);
  one.approximate(poses, all, {.seed = 3});
  three.approximate(poses, threads, {.seed = 3});
  one.approximate(poses, other, {.seed = 9});
  int differ = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    one.approximate(std::span(poses).subspan(i, 1), single, {.seed = 3});
    for (const ApproximateGain& same : {threads[i], single[0]}) {
      EXPECT_EQ(all[i].gain, same.gain);
      EXPECT_EQ(all[i].standard_error, same.standard_error);
    }
    differ += all[i].gain != other[i].gain ? 1 : 0;
  }
  EXPECT_GT(differ, 20);
}

TEST_P(ApproximateInARoom, TakesOddRequestsAndStops) {
  const GainEvaluator one(room(), small_kinect(), {.model = GetParam()}, {.num_threads = 1});
  const std::vector<Pose> poses = test::poses_in(room()->snapshot(), 20, 6);
  std::vector<ApproximateGain> all(20), some(20);
  EXPECT_EQ(one.approximate({}, {}), 0U);
  ASSERT_EQ(one.approximate(poses, all), 20U);
  for (const int allowed : {0, 1, 13}) {
    int asked = 0;
    const std::size_t done =
        one.approximate(poses, some, {}, {.is_cancelled = [&] { return ++asked > allowed; }});
    EXPECT_EQ(done, static_cast<std::size_t>(allowed));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (i < done)
        EXPECT_EQ(some[i].gain, all[i].gain);
      else
        EXPECT_TRUE(std::isnan(some[i].gain));
    }
  }
  EXPECT_THROW(one.approximate(poses, all, {.share = 0}), Error);
  EXPECT_THROW(one.approximate(poses, all, {.share = 1.01}), Error);
  std::vector<ApproximateGain> few(3);
  EXPECT_THROW(one.approximate(poses, few), Error);
  // Nothing to see: outside, looking away.
  const std::vector<Pose> away(2, look_at({9, 0, 1}, {10, 0, 1}));
  std::vector<ApproximateGain> none(2);
  one.approximate(away, none);
  for (const ApproximateGain& estimate : none) {
    EXPECT_EQ(estimate.gain, 0);
    EXPECT_EQ(estimate.standard_error, 0);
  }
}

std::string model_name(const testing::TestParamInfo<GainModel>& info) {
  return std::string(gain_model_name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Models, ApproximateInARoom,
                         testing::Values(GainModel::paper, GainModel::surface, GainModel::combined),
                         model_name);

}  // namespace
}  // namespace viewgain
