// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Choosing views against brute force: best(), race(), best_set().
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stop_token>
#include <tuple>

#include "core/expect_error.hpp"
#include "grid/voxels.hpp"
#include "oracle/rays.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain {
namespace {

constexpr std::array kCriteria{Criterion::log_diagonal, Criterion::log_determinant,
                               Criterion::trace};

// A lump of occupied and unknown voxels in the middle of free space, to be looked at from outside.
BeliefGrid lump(std::uint64_t seed) {
  test::Random random(seed);
  BeliefGrid grid({.voxel_size = 0.01,
                   .workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}},
                   .prior_sigma = 0.01});
  const Eigen::Vector3d shift(test::uniform(random, -4, 4), test::uniform(random, -4, 4),
                              test::uniform(random, -4, 4));
  test::for_each_voxel(grid, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    const Eigen::Vector3d p = Eigen::Vector3d(x, y, z) - shift;
    const double r = p.norm() + 2 * std::sin(0.5 * x + 0.3 * z);
    if (r < 8) return;
    // The half that has been seen has a shell with evidence, the other a ragged shadow.
    if (r < 10 && x + y > 0) {
      test::set_occupied_with_belief(grid, {x, y, z}, random);
    } else if (r >= 11 || test::uniform(random, 0, 1) < 0.5) {
      grid.set({x, y, z}, -0.4F);
    }
  });
  return grid;
}

Sensor larger_sensor() {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {.width = 120, .height = 96, .fx = 150, .fy = 152, .cx = 59.2, .cy = 47.7};
  return sensor;
}

Sensor small_sensor() {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {.width = 46, .height = 35, .fx = 55, .fy = 57, .cx = 22.4, .cy = 17.1};
  return sensor;
}

void expect_exact(const GainEvaluator& evaluator, const std::vector<Pose>& poses, std::size_t k) {
  const std::vector<ViewGain> all = evaluator.evaluate(poses);
  std::vector<std::size_t> expected = best_indices(all, k);
  std::erase_if(expected, [&](std::size_t i) { return std::isnan(all[i].gain); });
  const BestViews best = evaluator.best(poses, k);
  ASSERT_EQ(best.indices, expected);
  ASSERT_EQ(best.gains.size(), expected.size());
  for (std::size_t j = 0; j < expected.size(); ++j) {
    EXPECT_TRUE(test::same_bits(best.gains[j], all[expected[j]]));
  }
  EXPECT_TRUE(best.complete);
}

TEST(BestViews, AreThoseOfTheLargestGainsTheFirstOfEqualOnes) {
  std::vector<Pose> poses = sphere_poses(60, 0.5);
  for (const Pose& pose : sphere_poses(60, 0.5)) poses.push_back(pose);
  poses[5].m[7] = std::nan("");
  const GainEvaluator evaluator(VoxelScene::build(lump(9)), small_sensor(), test::kPaper);
  for (const std::size_t k : {1U, 7U, 118U, 123U}) expect_exact(evaluator, poses, k);
  const std::vector<std::size_t> first = evaluator.best(poses, 2).indices;
  EXPECT_EQ(first[1], first[0] + 60);  // the same pose
  EXPECT_EQ(evaluator.best(poses, 120).indices.size(), 119U);

  // No view is chosen that cannot be.
  for (Pose& pose : poses) pose.m[7] = std::nan("");
  for (const BestViews& none : {evaluator.best(poses, 3), evaluator.race(poses, 3)}) {
    EXPECT_TRUE(none.indices.empty());
    EXPECT_TRUE(none.gains.empty());
    EXPECT_TRUE(none.complete);
    EXPECT_EQ(none.scored_gains.size(), none.scored_indices.size());
  }
}

TEST(BestViews, TakeOddRequestsAndStops) {
  const auto scene = VoxelScene::build(lump(5));
  const std::vector<Pose> poses = sphere_poses(200, 0.6);
  const GainEvaluator one(scene, small_sensor(), test::kPaper, {.num_threads = 1});
  EXPECT_TRUE(one.best(poses, 0).indices.empty());
  EXPECT_TRUE(one.best({}, 3).indices.empty());
  std::stop_source source;
  source.request_stop();
  const BestViews stopped = one.best(poses, 1, {}, {.stop = source.get_token()});
  EXPECT_FALSE(stopped.complete);
  EXPECT_TRUE(stopped.indices.empty());
  // After seven poses, the first of them bad.
  std::vector<Pose> some = poses;
  some[0].m[0] = std::nan("");
  int asked = 0;
  const BestViews partly = one.best(some, 9, {}, {.is_cancelled = [&] { return ++asked > 7; }});
  EXPECT_FALSE(partly.complete);
  std::vector<std::size_t> order = best_indices(one.evaluate(std::span(some).first(7)), 7);
  ASSERT_EQ(order.back(), 0U);
  order.pop_back();
  EXPECT_EQ(partly.indices, order);
}

std::vector<std::size_t> largest(std::span<const double> values, std::size_t k) {
  std::vector<ViewGain> gains(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) gains[i].gain = values[i];
  return best_indices(gains, k);
}

// What the way to each pose costs: up to the largest gain.
std::vector<double> random_costs(std::span<const ViewGain> gains, std::uint64_t seed) {
  test::Random random(seed);
  double most = 0;
  for (const ViewGain& gain : gains) most = std::fmax(most, gain.gain);
  std::vector<double> costs(gains.size());
  for (double& cost : costs) cost = test::uniform(random, 0.0, most);
  return costs;
}

TEST(BestViews, CostsAreSubtracted) {
  int cases = 0, changed = 0;
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    const GainEvaluator evaluator(VoxelScene::build(lump(8)), small_sensor(), {.model = model});
    std::vector<Pose> poses = sphere_poses(150, 0.6);
    poses[17].m[0] = std::nan("");
    const std::vector<ViewGain> all = evaluator.evaluate(poses);
    const std::vector<double> costs = random_costs(all, 3);
    std::vector<double> worth;
    for (std::size_t i = 0; i < all.size(); ++i) worth.push_back(all[i].gain - costs[i]);
    const BestViews best = evaluator.best(poses, 6, {.costs = costs});
    ASSERT_EQ(best.indices, largest(worth, 6));
    for (std::size_t j = 0; j < 6; ++j, ++cases) {
      EXPECT_EQ(best.worth[j], worth[best.indices[j]]);
      EXPECT_TRUE(test::same_bits(best.gains[j], all[best.indices[j]]));
    }
    const BestViews plain = evaluator.best(poses, 6);
    changed += plain.indices != best.indices ? 1 : 0;
    EXPECT_EQ(plain.worth[0], plain.gains[0].gain);
    EXPECT_EQ(largest(worth, 150).back(), 17U);
  }
  EXPECT_EQ(cases, 18);
  EXPECT_EQ(changed, 3);
}

// The farther the better; counts hits or runs besides.
class Height : public ViewMeasure, public RunMeasure {
 public:
  double measure(const Pose& pose, std::span<const ViewMeasure::Hit> hits) const override {
    return pose.translation().z() * static_cast<double>(hits.size());
  }
  double measure(const Pose& pose, std::span<const RunMeasure::Run> runs) const override {
    return -pose.translation().z() * static_cast<double>(runs.size());
  }
};

TEST(BestViews, AMeasureTakesTheGainsPlace) {
  const GainEvaluator evaluator(VoxelScene::build(lump(8)), small_sensor(), test::kPaper,
                                {.num_threads = 2});
  const std::vector<Pose> poses = sphere_poses(100, 0.6);
  const Height own;
  std::vector<double> by_hits(poses.size()), by_runs(poses.size()), costs(poses.size(), 0.0);
  evaluator.evaluate(poses, by_hits, static_cast<const ViewMeasure&>(own));
  evaluator.evaluate(poses, by_runs, static_cast<const RunMeasure&>(own));
  const BestViews hits = evaluator.best(poses, 5, {.measure = &own});
  const BestViews runs = evaluator.best(poses, 5, {.run_measure = &own});
  EXPECT_EQ(hits.indices, largest(by_hits, 5));
  EXPECT_EQ(runs.indices, largest(by_runs, 5));
  EXPECT_EQ(hits.worth[0], by_hits[hits.indices[0]]);
  EXPECT_NE(hits.indices[0], runs.indices[0]);
  EXPECT_TRUE(hits.gains.empty());
  costs[hits.indices[0]] = 1e9;
  const BestViews other = evaluator.best(poses, 4, {.costs = costs, .measure = &own});
  EXPECT_TRUE(std::equal(other.indices.begin(), other.indices.end(), hits.indices.begin() + 1));
  test::expect_error(ErrorCode::invalid_argument, "measure and run_measure cannot be used", [&] {
    (void)evaluator.best(poses, 1, {.measure = &own, .run_measure = &own});
  });
  costs[7] = INFINITY;
  test::expect_error(ErrorCode::invalid_argument, "finite",
                     [&] { (void)evaluator.best(poses, 1, {.costs = costs}); });
  costs.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "costs: 99, poses: 100",
                     [&] { (void)evaluator.best(poses, 1, {.costs = costs}); });
  test::expect_error(ErrorCode::invalid_argument, "costs: 99, poses: 100",
                     [&] { (void)evaluator.race(poses, 1, {.costs = costs}); });
}

TEST(Race, CostsAreSubtracted) {
  int right = 0, others = 0;
  constexpr int kMaps = 6;
  for (int map = 0; map < kMaps; ++map) {
    const GainModel model = map % 2 == 0 ? GainModel::surface : GainModel::paper;
    const GainEvaluator evaluator(VoxelScene::build(lump(60 + static_cast<std::uint64_t>(map))),
                                  larger_sensor(), {.model = model});
    const std::vector<Pose> poses = sphere_poses(300, 0.6);
    const std::vector<ViewGain> all = evaluator.evaluate(poses);
    const std::vector<double> costs = random_costs(all, static_cast<std::uint64_t>(map));
    BestConfig config{.seed = 7};
    others += evaluator.race(poses, 1, config).indices == evaluator.best(poses).indices ? 1 : 0;
    config.costs = costs;
    const BestViews race = evaluator.race(poses, 1, config);
    ASSERT_EQ(race.indices.size(), 1U);
    EXPECT_EQ(race.worth[0], all[race.indices[0]].gain - costs[race.indices[0]]);
    right += race.indices == evaluator.best(poses, 1, {.costs = costs}).indices ? 1 : 0;
  }
  EXPECT_GE(right, kMaps - 1);
  EXPECT_GE(others, kMaps - 2);
}

// The area that rays may find, by what they pass; also as what a ray finds on average.
class Promise : public RunMeasure {
 public:
  explicit Promise(bool averages) : averages_(averages) {}
  double measure(const Pose&, std::span<const RunMeasure::Run> runs) const override {
    double sum = 0;
    for (const RunMeasure::Run& run : runs) sum += run.end - run.begin;
    return averages_ && !runs.empty() ? sum / static_cast<double>(runs.size()) : sum;
  }

 private:
  bool averages_;
};

TEST(Race, FindsTheBestByAMeasureToo) {
  int right = 0, cases = 0;
  for (std::uint64_t map = 0; map < 2; ++map) {
    const auto scene = VoxelScene::build(lump(80 + map));
    const GainEvaluator evaluator(scene, larger_sensor(), test::kPaper, {.num_threads = 2});
    const GainEvaluator alone(scene, larger_sensor(), test::kPaper, {.num_threads = 1});
    const std::vector<Pose> poses = sphere_poses(300, 0.6);
    for (const bool averages : {false, true}) {
      const Promise own(averages);
      std::vector<double> all(poses.size());
      evaluator.evaluate(poses, all, own);
      std::vector<double> costs;
      for (std::size_t i = 0; i < all.size(); ++i) costs.push_back(0.3 * all[(7 * i) % all.size()]);
      for (const bool with_costs : {false, true}) {
        BestConfig config{.run_measure = &own};
        BestConfig exact{.run_measure = &own};
        if (with_costs) config.costs = exact.costs = costs;
        const BestViews race = evaluator.race(poses, 2, config);
        const BestViews best = evaluator.best(poses, 2, exact);
        ASSERT_EQ(race.indices.size(), 2U);
        for (std::size_t j = 0; j < 2; ++j) {
          const std::size_t i = race.indices[j];
          EXPECT_EQ(race.worth[j], all[i] - (with_costs ? costs[i] : 0.0));
        }
        EXPECT_GE(race.worth[0], 0.99 * best.worth[0]);
        right += race.indices[0] == best.indices[0] ? 1 : 0;
        EXPECT_EQ(race.scored_indices.size(), 24U);
        EXPECT_TRUE(race.gains.empty() && race.scored_gains.empty() && race.complete);
        const std::uint64_t all_rays = evaluator.rays_per_pose() * poses.size();
        EXPECT_LT(race.rays_traced, all_rays / 2);
        const BestViews again = alone.race(poses, 2, config);
        EXPECT_EQ(again.indices, race.indices);
        EXPECT_EQ(again.worth, race.worth);
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 8);
  EXPECT_GE(right, 6);
}

TEST(Race, ByAMeasureTakesOddRequests) {
  const GainEvaluator evaluator(VoxelScene::build(lump(3)), larger_sensor(), test::kPaper);
  const GainEvaluator small(VoxelScene::build(lump(3)), small_sensor(), test::kPaper);
  std::vector<Pose> poses = sphere_poses(200, 0.6);
  const Promise own(false);
  const Height hits;
  const BestConfig config{.run_measure = &own};
  EXPECT_TRUE(evaluator.race(poses, 0, config).indices.empty());
  EXPECT_TRUE(evaluator.race({}, 2, config).indices.empty());
  EXPECT_EQ(evaluator.race(poses, 1000, config).indices,
            evaluator.best(poses, 1000, {.run_measure = &own}).indices);
  // Images of few rays are measured in full.
  EXPECT_EQ(small.race(poses, 3, {.measure = &hits}).indices,
            small.best(poses, 3, {.measure = &hits}).indices);
  for (std::size_t i = 0; i < 190; ++i) poses[i].m[0] = std::nan("");
  EXPECT_EQ(evaluator.race(poses, 3, config).indices,
            evaluator.best(poses, 3, {.run_measure = &own}).indices);
  test::expect_error(ErrorCode::invalid_argument, "measure and run_measure cannot be used", [&] {
    (void)evaluator.race(poses, 1, {.measure = &hits, .run_measure = &own});
  });
}

// What a set of views gains together, on the oracle's rays and with dense matrices.
double joint_gain(const BeliefGrid& grid, const Sensor& sensor, Criterion criterion,
                  const std::vector<Pose>& views) {
  const oracle::DenseMap map(grid);
  std::map<std::tuple<int, int, int>, SymmetricMatrix3> added;
  for (const Pose& pose : views) {
    const auto rays =
        oracle::view_rays(grid.T_world_grid(), grid.voxel_size(), sensor.camera, 1, pose);
    const auto hits = oracle::trace(map, sensor, {}, pose);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (hits[i].kind == RayHit::Kind::none) continue;
      added[{hits[i].voxel.x, hits[i].voxel.y, hits[i].voxel.z}] +=
          measurement_information(rays[i].direction, sensor.sigmas(hits[i].range));
    }
  }
  const double sigma = grid.prior_sigma();
  double gain = 0;
  for (const auto& [key, information] : added) {
    SymmetricMatrix3 before = SymmetricMatrix3::identity(1 / (sigma * sigma));
    const Index3 voxel{std::get<0>(key), std::get<1>(key), std::get<2>(key)};
    const auto belief = grid.belief(voxel);
    if (grid.state(voxel) == VoxelState::occupied && belief) before += belief->information_matrix();
    gain += entropy(before, criterion) - entropy(before + information, criterion);
  }
  return gain;
}

TEST(BestSet, IsTheGreedySetOfTheOracle) {
  int cases = 0;
  for (std::uint64_t seed = 70; seed < 73; ++seed) {
    const BeliefGrid grid = lump(seed);
    Sensor sensor = small_sensor();
    sensor.camera = {.width = 16, .height = 12, .fx = 18.3, .fy = 18.7, .cx = 7.6, .cy = 5.4};
    const std::vector<Pose> poses = sphere_poses(14, 0.55);
    for (const Criterion criterion : kCriteria) {
      const GainEvaluator evaluator(VoxelScene::build(grid), sensor, test::by_paper(criterion));
      const ViewSet set = evaluator.best_set(poses, 4);
      ASSERT_EQ(set.indices.size(), 4U);
      std::vector<Pose> chosen;
      double before = 0;
      for (std::size_t j = 0; j < set.indices.size(); ++j) {
        double largest = 0;
        std::vector<double> gains;
        for (std::size_t i = 0; i < poses.size(); ++i) {
          std::vector<Pose> with = chosen;
          with.push_back(poses[i]);
          gains.push_back(joint_gain(grid, sensor, criterion, with) - before);
          const bool taken = std::find(set.indices.begin(), set.indices.begin() + std::ptrdiff_t(j),
                                       i) != set.indices.begin() + std::ptrdiff_t(j);
          if (!taken) largest = std::max(largest, gains.back());
          ++cases;
        }
        const std::size_t index = set.indices[j];
        // The oracle may send a ray in ten thousand to another voxel.
        EXPECT_NEAR(set.marginal[j].gain, gains[index], 2e-3 * gains[index]);
        EXPECT_GE(gains[index], (1 - 2e-3) * largest);
        chosen.push_back(poses[index]);
        before += gains[index];
      }
      EXPECT_NEAR(set.gain, joint_gain(grid, sensor, criterion, chosen), 2e-3 * set.gain);
    }
  }
  EXPECT_EQ(cases, 3 * 3 * 4 * 14);
}

TEST(BestSet, LazyEvaluationChangesNothingButTheWork) {
  const auto scene = VoxelScene::build(lump(80));
  const std::vector<Pose> poses = sphere_poses(80, 0.6);
  const GainEvaluator lazy(scene, small_sensor(), test::by_paper(Criterion::log_determinant));
  const ViewSet set = lazy.best_set(poses, 6);
  EXPECT_LT(set.evaluations, 80U * 4);
  const GainEvaluator threads(scene, small_sensor(), test::by_paper(Criterion::log_determinant),
                              {.num_threads = 3});
  EXPECT_EQ(threads.best_set(poses, 6).indices, set.indices);
  EXPECT_EQ(set.indices[0], best_indices(lazy.evaluate(poses), 1)[0]);
  for (std::size_t j = 1; j < set.indices.size(); ++j) {
    EXPECT_LE(set.marginal[j].gain, set.marginal[j - 1].gain * (1 + 1e-9));
  }
  const GainEvaluator plain(scene, small_sensor(), test::kPaper);
  EXPECT_EQ(plain.best_set(poses, 3).evaluations, 80U + 79U + 78U);
}

TEST(BestSet, TakesOddRequestsAndSecondLooksGainLess) {
  const auto scene = VoxelScene::build(lump(81));
  const GainEvaluator evaluator(scene, small_sensor(), test::kPaper);
  const std::vector<Pose> same(3, sphere_poses(5, 0.6)[1]);
  const ViewSet set = evaluator.best_set(same, 10);
  EXPECT_EQ(set.indices, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_LT(set.marginal[1].gain, 0.8 * set.marginal[0].gain);
  EXPECT_EQ(set.marginal[1].unknown_voxels, set.marginal[0].unknown_voxels);
  std::vector<Pose> with_bad = same;
  with_bad[0].m[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(evaluator.best_set(with_bad, 3).indices, (std::vector<std::size_t>{1, 2}));
  EXPECT_TRUE(evaluator.best_set(same, 0).indices.empty());
  EXPECT_TRUE(evaluator.best_set({}, 2).indices.empty());
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(evaluator.best_set(same, 2, {.stop = source.get_token()}).complete);
}

}  // namespace
}  // namespace viewgain
