// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// best_set() by the surface and the combined gain, against all subsets.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <stop_token>
#include <tuple>

#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

// What views show of hazard cells, from contributions(); the value of sets of them.
struct SetOracle {
  std::vector<double> worth;                 // a p of each cell [m²]
  std::vector<std::vector<double>> reached;  // R of each pose and cell

  SetOracle(const GainEvaluator& surface, const VoxelScene& scene, std::span<const Pose> poses) {
    const HazardField& hazard = scene.hazard();
    const int voxels = 1 << hazard.cell_shift();
    const double side = hazard.voxel_size() * voxels;
    const auto cell_of = [&](int i) { return static_cast<int>(std::floor(double(i) / voxels)); };
    std::map<std::tuple<int, int, int>, std::size_t> places;
    std::vector<std::map<std::size_t, double>> shown;
    for (const Pose& pose : poses) {
      std::map<std::size_t, double>& of_pose = shown.emplace_back();
      for (const VoxelContribution& part : surface.contributions(pose)) {
        if (part.state != VoxelState::unknown || !(part.gain > 0)) continue;
        const std::tuple cell(cell_of(part.voxel.x), cell_of(part.voxel.y), cell_of(part.voxel.z));
        const auto [found, is_new] = places.try_emplace(cell, worth.size());
        if (is_new) {
          worth.push_back(side * side * (1 - std::exp(-double(hazard.rate(part.voxel)) * side)));
        }
        of_pose[found->second] += part.gain;
      }
    }
    for (const std::map<std::size_t, double>& of_pose : shown) {
      std::vector<double>& R = reached.emplace_back(worth.size(), 0.0);
      for (const auto& [cell, area] : of_pose) R[cell] = std::min(1.0, area / worth[cell]);
    }
  }
  [[nodiscard]] double value(std::span<const std::size_t> set) const {
    double sum = 0;
    for (std::size_t cell = 0; cell < worth.size(); ++cell) {
      double missed = 1;
      for (const std::size_t i : set) missed *= 1 - reached[i][cell];
      sum += worth[cell] * (1 - missed);
    }
    return sum;
  }
  [[nodiscard]] double by_best_alone(std::span<const std::size_t> set) const {
    double sum = 0;
    for (std::size_t cell = 0; cell < worth.size(); ++cell) {
      double largest = 0;
      for (const std::size_t i : set) largest = std::max(largest, reached[i][cell]);
      sum += worth[cell] * largest;
    }
    return sum;
  }
};

struct Made : test::RandomCase {
  std::shared_ptr<const VoxelScene> scene = VoxelScene::build(map.grid);

  Made(std::uint64_t seed, std::size_t count)
      : test::RandomCase(test::random_case(seed, test::MapFamily::tiles_8, count)) {}
};

TEST(SurfaceSet, IsPlainGreedysAndNearTheBestOfAllSubsets) {
  constexpr std::size_t kPoses = 12, kChosen = 3;
  int maps = 0, subsets = 0, better_than_singles = 0;
  double least_share = 1;
  for (std::uint64_t seed = 200; seed < 212; ++seed) {
    const Made made(seed, kPoses);
    const GainEvaluator evaluator(made.scene, made.sensor, {.model = GainModel::surface});
    const SetOracle oracle(evaluator, *made.scene, made.poses);
    const ViewSet set = evaluator.best_set(made.poses, kChosen);
    double best = 0;
    for (std::uint32_t bits = 0; bits < 1U << kPoses; ++bits) {
      if (std::popcount(bits) != int(kChosen)) continue;
      std::vector<std::size_t> subset;
      for (std::size_t i = 0; i < kPoses; ++i) {
        if ((bits >> i & 1U) != 0) subset.push_back(i);
      }
      best = std::max(best, oracle.value(subset));
      ++subsets;
    }
    const double tolerance = 1e-6 * best;
    std::vector<std::size_t> chosen;
    for (std::size_t j = 0; j < set.indices.size(); ++j) {
      const double before = oracle.value(chosen);
      double largest = 0;
      for (std::size_t i = 0; i < kPoses; ++i) {
        chosen.push_back(i);
        largest = std::max(largest, oracle.value(chosen) - before);
        chosen.pop_back();
      }
      chosen.push_back(set.indices[j]);
      EXPECT_NEAR(set.marginal[j].gain, largest, tolerance);
      EXPECT_NEAR(set.marginal[j].gain, oracle.value(chosen) - before, tolerance);
    }
    EXPECT_NEAR(set.gain, oracle.value(chosen), tolerance);
    EXPECT_NEAR(set.gain_by_best_alone, oracle.by_best_alone(chosen), tolerance);
    EXPECT_LE(set.gain_by_best_alone, set.gain + tolerance);
    if (best == 0) continue;
    ++maps;
    least_share = std::min(least_share, set.gain / best);
    const auto singles = best_indices(evaluator.evaluate(made.poses), kChosen);
    const double of_singles = oracle.value(singles);
    EXPECT_GE(set.gain, of_singles - tolerance);
    better_than_singles += set.gain > of_singles + tolerance ? 1 : 0;
  }
  RecordProperty("least_share", std::to_string(least_share));
  RecordProperty("better_than_singles", better_than_singles);
  EXPECT_GE(least_share, 0.98);
  EXPECT_GE(maps, 10);
  EXPECT_GE(better_than_singles, 3);
  EXPECT_EQ(subsets, 12 * 220);
}

class SetsByBoth : public testing::TestWithParam<GainModel> {};

TEST_P(SetsByBoth, OneViewIsWorthItsGainAtMostAndTheOrderIsAllTheSame) {
  const Made made(230, 30);
  const GainEvaluator evaluator(made.scene, made.sensor, {.model = GetParam()});
  const std::vector<ViewGain> gains = evaluator.evaluate(made.poses);
  int singles = 0, pairs = 0, overlap = 0;
  for (std::size_t i = 0; i + 1 < made.poses.size(); ++i) {
    const auto alone = evaluator.best_set(std::span(made.poses).subspan(i, 1), 1);
    if (gains[i].status != ViewGain::Status::ok || alone.indices.empty()) continue;
    EXPECT_LE(alone.gain, gains[i].gain * (1 + 1e-5));
    EXPECT_EQ(alone.gain_by_best_alone > 0, alone.gain > 0);
    EXPECT_EQ(alone.marginal[0].hits, gains[i].hits);
    if (GetParam() == GainModel::combined) {
      EXPECT_NEAR(alone.marginal[0].refinement_saturated, gains[i].refinement_saturated,
                  1e-5 * gains[i].refinement_saturated);
    }
    ++singles;
    const std::vector<Pose> pair{made.poses[i], made.poses[i + 1]}, turned{pair[1], pair[0]};
    const ViewSet one = evaluator.best_set(pair, 2), other = evaluator.best_set(turned, 2);
    EXPECT_NEAR(one.gain, other.gain, 1e-9 * one.gain);
    if (one.indices.size() < 2) continue;
    ++pairs;
    const auto next = evaluator.best_set(std::span(made.poses).subspan(i + 1, 1), 1);
    overlap += one.gain < (alone.gain + next.gain) * (1 - 1e-9) ? 1 : 0;
  }
  EXPECT_GE(singles, 15);
  EXPECT_GE(pairs, 10);
  EXPECT_GE(overlap, 5);
}

TEST_P(SetsByBoth, ThreadsChangeNothingAndOddRequestsAreTaken) {
  const Made made(231, 80);
  std::vector<Pose> poses = made.poses;
  const GainEvaluator one(made.scene, made.sensor, {.model = GetParam()}, {.num_threads = 1});
  const GainEvaluator three(made.scene, made.sensor, {.model = GetParam()}, {.num_threads = 3});
  const ViewSet set = one.best_set(poses, 5), same = three.best_set(poses, 5);
  ASSERT_EQ(set.indices.size(), 5U);
  EXPECT_EQ(set.indices, same.indices);
  EXPECT_EQ(set.gain, same.gain);
  EXPECT_EQ(set.gain_by_best_alone, same.gain_by_best_alone);
  EXPECT_EQ(set.evaluations, same.evaluations);
  if (GetParam() == GainModel::surface) {
    EXPECT_LT(set.evaluations, 80U * 4);
    for (std::size_t j = 1; j < 5; ++j) {
      EXPECT_LE(set.marginal[j].gain, set.marginal[j - 1].gain * (1 + 1e-9));
    }
  }
  const std::size_t winner = set.indices[0];
  poses[winner].m[3] = std::numeric_limits<double>::quiet_NaN();
  const ViewSet all = one.best_set(poses, 500);
  EXPECT_LE(all.indices.size(), 79U);
  EXPECT_EQ(std::count(all.indices.begin(), all.indices.end(), winner), 0);
  const std::vector<Pose> twice(2, made.poses[winner]);
  const ViewSet again = one.best_set(twice, 2);
  EXPECT_EQ(again.indices, (std::vector<std::size_t>{0, 1}));
  EXPECT_LT(again.marginal[1].gain, again.marginal[0].gain);
  EXPECT_TRUE(one.best_set(poses, 0).indices.empty());
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(one.best_set(poses, 2, {.stop = source.get_token()}).complete);
}

TEST(SurfaceSet, WeightsScaleTheValue) {
  const Made made(232, 20);
  const GainEvaluator plain(made.scene, made.sensor, {.model = GainModel::surface});
  const Box all{{-1e3, -1e3, -1e3}, {1e3, 1e3, 1e3}};
  const GainEvaluator weighted(made.scene, made.sensor,
                               {.model = GainModel::surface, .weights = {{all, 3.0}}});
  const ViewSet set = plain.best_set(made.poses, 3), scaled = weighted.best_set(made.poses, 3);
  EXPECT_GT(set.gain, 0);
  EXPECT_EQ(scaled.indices, set.indices);
  EXPECT_NEAR(scaled.gain, 3 * set.gain, 1e-6 * scaled.gain);
}

INSTANTIATE_TEST_SUITE_P(Gains, SetsByBoth,
                         testing::Values(GainModel::surface, GainModel::combined),
                         [](const auto& gain) { return std::string(gain_model_name(gain.param)); });

}  // namespace
}  // namespace viewgain
