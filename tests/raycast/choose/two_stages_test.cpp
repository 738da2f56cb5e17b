// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// race(), which chooses in two stages, by each gain, against scoring all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

#include "grid/voxels.hpp"
#include "raycast/scene_makers.hpp"
#include "support/room_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {
namespace {

constexpr std::array kModels{GainModel::paper, GainModel::surface, GainModel::combined};
constexpr std::uint64_t kCoarseRays = 24 * 20;  // every fifth pixel and row

Sensor sensor_of(int width, int height) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {.width = width,
                   .height = height,
                   .fx = 1.25 * width,
                   .fy = 1.25 * width,
                   .cx = 0.5 * width - 0.3,
                   .cy = 0.5 * height + 0.2};
  return sensor;
}

// A ball in free space: one half has been seen, the other is unknown, of another shape each time.
BeliefGrid ball(int number) {
  test::Random random(static_cast<unsigned>(number));
  BeliefGrid grid({.voxel_size = 0.01,
                   .workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}},
                   .prior_sigma = 0.01});
  const double turn = test::uniform(random, 0, 6), wave = test::uniform(random, 1, 3);
  test::for_each_voxel(grid, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    const double r = std::sqrt(x * x + y * y + z * z) + wave * std::sin(0.4 * x + 0.3 * z);
    const bool is_seen = x * std::cos(turn) + y * std::sin(turn) > 2;
    if (is_seen && r >= 9 && r < 11) {
      test::set_occupied_with_belief(grid, {x, y, z}, random);
    } else if (r >= 11 && (is_seen || r > 15)) {
      grid.set({x, y, z}, -0.4F);
    }
  });
  return grid;
}

class TwoStages : public testing::TestWithParam<GainModel> {
 protected:
  [[nodiscard]] GainEvaluator evaluator(const std::shared_ptr<const VoxelScene>& scene,
                                        int threads = 1) const {
    return GainEvaluator(scene, sensor_of(120, 96), {.model = GetParam()},
                         {.num_threads = threads});
  }
  const std::vector<Pose> poses_ = sphere_poses(400, 0.6);
};

TEST_P(TwoStages, FindsNearlyTheBestAndReportsExactGains) {
  constexpr int kMaps = 5;
  int checks = 0, near = 0;
  for (int map = 0; map < kMaps; ++map) {
    SCOPED_TRACE(map);
    const auto scene = VoxelScene::build(ball(map));
    const GainEvaluator one = evaluator(scene);
    const std::vector<ViewGain> all = one.evaluate(poses_);
    for (const std::size_t k : {std::size_t{1}, std::size_t{12}}) {
      const BestViews raced = one.race(poses_, k);
      EXPECT_TRUE(raced.complete);
      ASSERT_EQ(raced.scored_indices.size(), std::max<std::size_t>(24, 4 * k));
      // By the paper's gain they begin anywhere in the cells, so that one more or less fits in.
      const std::uint64_t in_full = raced.scored_indices.size() * one.rays_per_pose();
      if (GetParam() != GainModel::paper) {
        EXPECT_EQ(raced.rays_traced, poses_.size() * kCoarseRays + in_full);
      } else {
        EXPECT_LE(raced.rays_traced, poses_.size() * kCoarseRays + in_full);
        EXPECT_GE(raced.rays_traced, poses_.size() * kCoarseRays * 9 / 10 + in_full);
      }
      EXPECT_TRUE(std::is_sorted(raced.scored_indices.begin(), raced.scored_indices.end()));
      for (std::size_t j = 0; j < raced.scored_indices.size(); ++j) {
        EXPECT_TRUE(test::same_bits(raced.scored_gains[j], all[raced.scored_indices[j]]));
      }
      ASSERT_EQ(raced.indices.size(), k);
      const std::vector<std::size_t> order = best_indices(raced.scored_gains, k);
      for (std::size_t j = 0; j < k; ++j) {
        EXPECT_EQ(raced.indices[j], raced.scored_indices[order[j]]);
        EXPECT_TRUE(test::same_bits(raced.gains[j], all[raced.indices[j]]));
      }
      const double best = all[best_indices(all, 1)[0]].gain;
      ASSERT_GT(best, 0);
      near += raced.gains[0].gain >= 0.99 * best ? 1 : 0;
      EXPECT_GE(raced.gains[0].gain, 0.95 * best);
      ++checks;
    }
  }
  EXPECT_EQ(checks, 2 * kMaps);
  EXPECT_GE(near, 2 * kMaps - 1);
}

TEST_P(TwoStages, SameBitsForAnyNumberOfThreads) {
  const auto scene = VoxelScene::build(ball(3));
  const BestViews expected = evaluator(scene, 1).race(poses_, 3);
  for (const int threads : {2, 5}) {
    const BestViews actual = evaluator(scene, threads).race(poses_, 3);
    EXPECT_EQ(actual.indices, expected.indices);
    EXPECT_EQ(actual.scored_indices, expected.scored_indices);
    EXPECT_TRUE(test::same_bits(actual.scored_gains, expected.scored_gains));
    EXPECT_EQ(actual.rays_traced, expected.rays_traced);
  }
}

TEST_P(TwoStages, TakesOddRequests) {
  const GainEvaluator one = evaluator(VoxelScene::build(ball(1)));
  EXPECT_TRUE(one.race(poses_, 0).indices.empty());
  EXPECT_TRUE(one.race({}, 2).indices.empty());
  // All are asked for: all are scored in full, in one stage.
  const BestViews all = one.race(poses_, 1000);
  EXPECT_EQ(all.indices, one.best(poses_, poses_.size()).indices);
  EXPECT_EQ(all.rays_traced, poses_.size() * one.rays_per_pose());
  // Bad poses are not chosen, however few others there are.
  std::vector<Pose> bad = poses_;
  for (std::size_t i = 0; i < 395; ++i) bad[i].m[0] = std::nan("");
  const BestViews few = one.race(bad, 8);
  EXPECT_EQ(few.indices, one.best(bad, 8).indices);
  ASSERT_EQ(few.gains.size(), 5U);
  EXPECT_FALSE(std::isnan(few.gains[4].gain));
}

TEST_P(TwoStages, PosesWithoutGainAreChosenInOrder) {
  const GainEvaluator one = evaluator(VoxelScene::build(ball(1)));
  // They look away.
  std::vector<Pose> away;
  for (int i = 0; i < 100; ++i) away.push_back(look_at({0.6, 0.01 * i, 0}, {1.2, 0, 0}));
  const BestViews raced = one.race(away, 3);
  EXPECT_EQ(raced.indices, (std::vector<std::size_t>{0, 1, 2}));
  ASSERT_EQ(raced.gains.size(), 3U);
  for (const ViewGain& gain : raced.gains) EXPECT_EQ(gain.gain, 0.0);
}

TEST_P(TwoStages, ImagesOfFewRaysAreScoredInFull) {
  const GainEvaluator one(VoxelScene::build(ball(2)), sensor_of(24, 18), {.model = GetParam()},
                          {.num_threads = 1});
  const BestViews raced = one.race(poses_, 2);
  EXPECT_EQ(raced.scored_indices.size(), poses_.size());
  EXPECT_EQ(raced.indices, one.best(poses_, 2).indices);
}

TEST_P(TwoStages, StopsInEitherStage) {
  const GainEvaluator one = evaluator(VoxelScene::build(ball(1)));
  std::stop_source source;
  source.request_stop();
  const BestViews none = one.race(poses_, 2, {}, {.stop = source.get_token()});
  EXPECT_FALSE(none.complete);
  EXPECT_TRUE(none.indices.empty());
  EXPECT_EQ(none.rays_traced, 0U);

  const BestViews whole = one.race(poses_, 2);
  // It is asked before each pose of each stage.
  for (const std::size_t scored : {std::size_t{0}, std::size_t{5}, std::size_t{23}}) {
    SCOPED_TRACE(scored);
    std::size_t asked = 0;
    const BestViews part =
        one.race(poses_, 2, {}, {.is_cancelled = [&] { return ++asked > poses_.size() + scored; }});
    EXPECT_FALSE(part.complete);
    ASSERT_EQ(part.scored_indices.size(), scored);
    for (std::size_t j = 0; j < scored; ++j) {
      const auto& all = whole.scored_indices;
      const auto at = std::find(all.begin(), all.end(), part.scored_indices[j]);
      ASSERT_NE(at, all.end());
      EXPECT_TRUE(test::same_bits(part.scored_gains[j],
                                  whole.scored_gains[static_cast<std::size_t>(at - all.begin())]));
    }
    EXPECT_EQ(part.indices.size(), std::min<std::size_t>(2, scored));
  }
  std::size_t asked = 0;
  const BestViews early =
      one.race(poses_, 2, {}, {.is_cancelled = [&] { return ++asked > poses_.size() / 2; }});
  EXPECT_FALSE(early.complete);
  EXPECT_TRUE(early.scored_indices.empty());
}

TEST_P(TwoStages, ADeadlineLeavesTheBestOfWhatWasScoredInTime) {
  const GainEvaluator two = evaluator(VoxelScene::build(ball(2)), 2);
  const std::vector<ViewGain> all = two.evaluate(poses_);
  const BestViews whole = two.race(poses_, 3);
  EXPECT_EQ(whole.estimated, poses_.size());
  const BestViews late = two.race(poses_, 3, {.deadline = 1e6});
  EXPECT_TRUE(late.complete);
  EXPECT_EQ(late.indices, whole.indices);
  EXPECT_EQ(late.scored_indices, whole.scored_indices);
  EXPECT_EQ(late.rays_traced, whole.rays_traced);
  EXPECT_EQ(two.best(poses_, 3, {.deadline = 1e6}).indices, best_indices(all, 3));
  std::size_t cut = 0;
  for (const double deadline : {0.0, 1e-4, 1e-3, 4e-3, 1.6e-2, 6.4e-2}) {
    SCOPED_TRACE(deadline);
    for (const bool in_two : {true, false}) {
      const BestConfig config{.deadline = deadline};
      const BestViews some = in_two ? two.race(poses_, 3, config) : two.best(poses_, 3, config);
      const std::size_t scored = some.scored_indices.size();
      EXPECT_LE(some.estimated, in_two ? poses_.size() : 0U);
      EXPECT_LE(scored, in_two ? whole.scored_indices.size() : poses_.size());
      if (deadline == 0) {
        EXPECT_EQ(some.estimated + scored + some.rays_traced, 0U);
      }
      EXPECT_EQ(some.complete,
                in_two ? some.estimated == poses_.size() && scored == whole.scored_indices.size()
                       : scored == poses_.size());
      ASSERT_EQ(some.scored_gains.size(), scored);
      for (std::size_t j = 0; j < scored; ++j) {
        EXPECT_TRUE(test::same_bits(some.scored_gains[j], all[some.scored_indices[j]]));
      }
      const std::vector<std::size_t> order = best_indices(some.scored_gains, 3);
      ASSERT_EQ(some.indices.size(), order.size());
      for (std::size_t j = 0; j < order.size(); ++j) {
        EXPECT_EQ(some.indices[j], some.scored_indices[order[j]]);
      }
      cut += some.complete ? 0U : 1U;
    }
  }
  EXPECT_GE(cut, 4U);
  for (const double bad : {-1e-9, std::nan("")}) {
    EXPECT_THROW((void)two.race(poses_, 3, {.deadline = bad}), Error);
  }
}

std::string model_name(const testing::TestParamInfo<GainModel>& info) {
  return std::string(gain_model_name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Models, TwoStages, testing::ValuesIn(kModels), model_name);

// Choosing where voxels are large in the image: race() and approximate() in a room, against scoring
// all.

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

class ApproximateInARoom : public testing::TestWithParam<GainModel> {};

TEST_P(ApproximateInARoom, StandardErrorsCoverTheTruth) {
  const GainEvaluator evaluator(room(), small_kinect(), {.model = GetParam()});
  std::vector<Pose> poses = test::poses_in(room()->snapshot(), 300, 3);
  // Before a wall that blocks most rays a part of them has too few with a gain to tell its scatter.
  std::erase_if(poses, [&](const Pose& pose) {
    const GainEvaluator::RayOutcomes outcomes = evaluator.outcomes(pose);
    return 2 * outcomes.too_near > outcomes.rays;
  });
  EXPECT_GT(poses.size(), 150U);
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

INSTANTIATE_TEST_SUITE_P(Models, ApproximateInARoom, testing::ValuesIn(kModels), model_name);

}  // namespace
}  // namespace viewgain
