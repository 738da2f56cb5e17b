// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/view_scorer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "oracle/dense_map.hpp"
#include "oracle/surface.hpp"
#include "raycast/scene_makers.hpp"
#include "raycast/scorer/scorer_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::same_bits;
using test::ScorerParts;
using test::ScorerScene;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void expect_same(const std::vector<ViewGain>& actual, const std::vector<ViewGain>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_TRUE(same_bits(actual[i], expected[i])) << "pose " << i;
  }
}

TEST(ViewScorer, GainsAfterFramesAreThoseOfTheParts) {
  const ScorerScene scene;
  std::size_t frames = 0;
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    ViewScorer scorer(scene.sensor, scene.config(model), {2});
    ScorerParts parts(scene.sensor, scene.config(model));
    expect_same(scorer.evaluate(scene.poses), parts.evaluator().evaluate(scene.poses));
    for (std::size_t view = 0; view < 3; ++view) {
      const Pose& pose = scene.poses[5 * view];
      const DepthFrame frame = scene.see(pose, view);
      const MapUpdate update = scorer.add(frame, pose);
      parts.add(frame, pose);
      EXPECT_EQ(update.verdict, FrameVerdict::used);
      EXPECT_EQ(std::isnan(update.new_area), model == GainModel::paper);
      EXPECT_EQ(scorer.grid().content_hash(), parts.grid().content_hash());
      EXPECT_EQ(&scorer.evaluator()->scene(), scorer.scene().get());
      expect_same(scorer.evaluate(scene.poses), parts.evaluator().evaluate(scene.poses));
      ++frames;
    }
    EXPECT_EQ(scorer.progress().unknown_voxels, parts.grid().statistics().unknown);
    EXPECT_EQ(scorer.consistency().frames.size(), 3U);
  }
  EXPECT_EQ(frames, 9U);
}

// Any order of calls comes to the same map and gains as the parts by hand.
TEST(ViewScorer, AnyOrderOfCallsIsThatOfTheParts) {
  const ScorerScene scene;
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "map.vdb").string();
  std::size_t adds = 0, sets = 0, forgets = 0, loads = 0, gains = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) { return random() % n; };
    const ScorerConfig config = scene.config(static_cast<GainModel>(seed % 3));
    ViewScorer scorer(scene.sensor, config, {2});
    ScorerParts parts(scene.sensor, config);
    const Index3 low = scorer.grid().min_index(), dims = scorer.grid().dims();
    for (int step = 0; step < 12; ++step) {
      switch (below(5)) {
        case 0: {
          const Pose& pose = scene.poses[below(static_cast<std::uint32_t>(scene.poses.size()))];
          const DepthFrame frame = scene.see(pose, random());
          scorer.add(frame, pose);
          parts.add(frame, pose);
          ++adds;
          break;
        }
        case 1: {
          VoxelBox box;
          for (const auto member : {&Index3::x, &Index3::y, &Index3::z}) {
            box.min.*member =
                low.*member + static_cast<int>(below(static_cast<std::uint32_t>(dims.*member - 8)));
            box.max.*member = box.min.*member + 1 + static_cast<int>(below(8));
          }
          std::vector<std::uint8_t> labels(box.volume());
          for (std::uint8_t& label : labels) label = static_cast<std::uint8_t>(below(3));
          EXPECT_EQ(scorer.set(box, labels), parts.grid().update_box(box, labels));
          ++sets;
          break;
        }
        case 2: {
          const double x = 0.01 * (static_cast<double>(below(30)) - 15);
          const Box region{{x, -0.1, 0}, {x + 0.05, 0.1, 0.1}};
          EXPECT_EQ(scorer.forget(region), parts.grid().forget(region));
          ++forgets;
          break;
        }
        case 3: {
          scorer.save(file);
          scorer = ViewScorer::load(file, scene.sensor, config, {1});
          ++loads;
          break;
        }
        default: {
          expect_same(scorer.evaluate(scene.poses), parts.evaluator().evaluate(scene.poses));
          ++gains;
        }
      }
      ASSERT_EQ(scorer.grid().content_hash(), parts.grid().content_hash())
          << "seed " << seed << ", step " << step;
    }
    expect_same(scorer.evaluate(scene.poses), parts.evaluator().evaluate(scene.poses));
  }
  EXPECT_EQ(adds + sets + forgets + loads + gains, 72U);
  EXPECT_GT(std::min({adds, sets, forgets, loads, gains}), 5U);
}

// Of labels the combined gain is the surface gain in another unit.
TEST(ViewScorer, LabelsAreNotRefined) {
  const ScorerScene scene;
  ScorerConfig config = scene.config();
  config.hazard.object_size = 0.1;
  ViewScorer combined(scene.sensor, config, {1});
  config.gain.model = GainModel::surface;
  ViewScorer surface(scene.sensor, config, {1});
  // The near half is free, in its middle stands a block.
  const Index3 low = combined.grid().min_index(), dims = combined.grid().dims();
  VoxelBox box{low, {low.x + dims.x, low.y + dims.y / 2, low.z + dims.z}};
  std::vector<std::uint8_t> labels;
  for (int x = box.min.x; x < box.max.x; ++x) {
    for (int y = box.min.y; y < box.max.y; ++y) {
      for (int z = box.min.z; z < box.max.z; ++z) {
        const bool is_block = std::abs(x) < 8 && y > box.max.y - 8 && z < low.z + 10;
        labels.push_back(is_block ? 2 : 1);
      }
    }
  }
  EXPECT_GT(combined.set(box, labels), 0U);
  surface.set(box, labels);
  const auto nats = combined.evaluate(scene.poses), areas = surface.evaluate(scene.poses);
  double factor = 0;
  std::size_t gaining = 0, meeting = 0;
  for (std::size_t i = 0; i < nats.size(); ++i) {
    EXPECT_EQ(nats[i].refinement_saturated, 0);
    EXPECT_EQ(nats[i].area, areas[i].area);
    meeting += nats[i].occupied_voxels > 0 ? 1 : 0;
    if (!(areas[i].gain > 0)) continue;
    ++gaining;
    if (factor == 0) factor = nats[i].gain / areas[i].gain;
    EXPECT_NEAR(nats[i].gain, factor * areas[i].gain, 1e-12 * nats[i].gain);
  }
  EXPECT_GT(gaining, 10U);
  EXPECT_GT(meeting, 10U);
  // A view of the block from the frames' model does refine it.
  const Pose& pose = scene.poses.front();
  combined.add(scene.see(pose), pose);
  EXPECT_GT(combined.evaluate(std::span(&pose, 1)).front().refinement_saturated, 0);
}

TEST(ViewScorer, TheBestAreTheRacesAndPossibleIfThereIsABody) {
  const ScorerScene scene;
  Sensor sensor = scene.sensor;
  ASSERT_FALSE(sensor.body_size.has_value());
  std::vector<Pose> poses = scene.poses;
  poses.push_back(look_at({0, 0, 0.1}, {0, 0, 0.05}));      // over the block, too near
  poses.push_back(look_at({0.12, 0, 0.05}, {0, 0, 0.05}));  // in a wall
  std::vector<double> costs;
  for (std::size_t i = 0; i < poses.size(); ++i) costs.push_back(2.0 * static_cast<double>(i % 7));
  for (const bool has_body : {false, true}) {
    if (has_body) sensor.body_size = {0.065, 0.065, 0.076};
    ViewScorer scorer(sensor, scene.config(), {2});
    for (std::size_t i : {0, 9}) scorer.add(scene.see(poses[i], i), poses[i]);
    std::vector<std::size_t> numbers(poses.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
    if (has_body) {
      const FeasibilityChecker checker(scorer.scene(), feasibility_of(sensor));
      numbers = feasible_poses(checker, poses, {}).numbers;
      EXPECT_LT(numbers.size(), poses.size());
      EXPECT_GT(numbers.size(), 10U);
    }
    std::vector<Pose> possible;
    std::vector<double> possible_costs;
    for (const std::size_t i : numbers) {
      possible.push_back(poses[i]);
      possible_costs.push_back(costs[i]);
    }
    for (const bool has_costs : {false, true}) {
      BestConfig all, some;
      if (has_costs) all.costs = costs, some.costs = possible_costs;
      const BestViews actual = scorer.best(poses, 4, all);
      const BestViews expected = scorer.evaluator()->race(possible, 4, some);
      ASSERT_EQ(actual.indices.size(), 4U);
      ASSERT_EQ(actual.scored_indices.size(), expected.scored_indices.size());
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(actual.indices[i], numbers[expected.indices[i]]);
        EXPECT_TRUE(same_bits(actual.gains[i], expected.gains[i]));
        EXPECT_EQ(actual.worth[i], expected.worth[i]);
      }
      for (std::size_t i = 0; i < actual.scored_indices.size(); ++i) {
        EXPECT_EQ(actual.scored_indices[i], numbers[expected.scored_indices[i]]);
      }
    }
    for (const std::size_t wrong : {std::size_t{1}, possible.size() - 1}) {
      const BestConfig config{.costs = std::span(costs).first(wrong)};
      expect_error(ErrorCode::invalid_argument, "cost",
                   [&] { (void)scorer.best(poses, 1, config); });
    }
    for (const double deadline : {-1.0, kNan}) {
      expect_error(ErrorCode::invalid_argument, "deadline",
                   [&] { (void)scorer.best(poses, 1, {.deadline = deadline}); });
    }
    // A deadline that has passed scores hardly any.
    EXPECT_FALSE(scorer.best(poses, 1, {.deadline = 0}).complete);
    EXPECT_TRUE(scorer.best({}, 3).indices.empty());
    const std::vector<Pose> none{poses.back()};
    EXPECT_EQ(scorer.best(none).indices.size(), has_body ? 0U : 1U);
  }
}

// A map of frames and labels, with task weights, against the slow oracle.
TEST(ViewScorer, OnlyMeasuredVoxelsAreRefinedAlsoBesideLabels) {
  const ScorerScene scene;
  ScorerConfig config = scene.config();
  config.obstacles = {};
  config.support_plane.reset();
  config.hazard.object_size = 0.1;
  std::size_t checks = 0;
  for (const bool has_weights : {false, true}) {
    if (has_weights) config.gain.weights = {{{{-0.15, -0.12, 0}, {0, 0.12, 0.12}}, 3.0}};
    ViewScorer scorer(scene.sensor, config, {1});
    for (const std::size_t i : {0, 7}) scorer.add(scene.see(scene.poses[i], i), scene.poses[i]);
    const VoxelBox front = VoxelBox::from_dims({-4, -4, 8}, {8, 8, 4});
    EXPECT_GT(scorer.set(front, std::vector<std::uint8_t>(front.volume(), 2)), 0U);
    const BeliefGrid& grid = scorer.grid();
    const oracle::DenseMap map(grid);
    const HazardField hazard(grid.snapshot(), config.hazard);
    for (std::size_t i = 0; i < scene.poses.size(); i += 5) {
      const Pose& pose = scene.poses[i];
      const double expected =
          oracle::surface_value(grid, map, hazard, scene.sensor, config.gain, pose)
              .refinement_saturated;
      const ViewGain actual = scorer.evaluate(std::span(&pose, 1)).front();
      EXPECT_NEAR(actual.refinement_saturated, expected, 1e-4 * expected + 1e-9) << i;
      double sum = 0;
      for (const VoxelContribution& part : scorer.evaluator()->contributions(pose)) {
        sum += part.gain;
      }
      EXPECT_NEAR(sum, actual.gain, 1e-5 * actual.gain) << i;
      checks += expected > 1 ? 1 : 0;
    }
  }
  EXPECT_GE(checks, 6U);
}

TEST(ViewScorer, AMeasureOfOnesOwnIsTheEvaluators) {
  struct Hits : ViewMeasure {
    [[nodiscard]] double measure(const Pose&, std::span<const Hit> hits) const override {
      return static_cast<double>(hits.size());
    }
  };
  struct Runs : RunMeasure {
    [[nodiscard]] double measure(const Pose&, std::span<const Run> runs) const override {
      return static_cast<double>(runs.size());
    }
  };
  const ScorerScene scene;
  ViewScorer scorer(scene.sensor, scene.config(), {1});
  scorer.add(scene.see(scene.poses[0]), scene.poses[0]);
  std::vector<double> expected(scene.poses.size());
  scorer.evaluator()->evaluate(scene.poses, expected, Hits{});
  EXPECT_EQ(scorer.evaluate(scene.poses, Hits{}), expected);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 100);
  scorer.evaluator()->evaluate(scene.poses, expected, Runs{});
  EXPECT_EQ(scorer.evaluate(scene.poses, Runs{}), expected);
}

TEST(ViewScorer, WhatIsRefusedChangesNothing) {
  const ScorerScene scene;
  ViewScorer scorer(scene.sensor, scene.config(), {1});
  const Pose& pose = scene.poses[0];
  scorer.add(scene.see(pose), pose);
  const std::string hash = scorer.grid().content_hash();
  const auto before = scorer.scene();
  DepthFrame frame = scene.see(pose);
  expect_error(ErrorCode::invalid_argument, "pose_sigma must be at least 0 and finite, not -1",
               [&] {
                 scorer.add(frame, pose, {-1, 0});
               });
  frame.identity = "?";
  expect_error(ErrorCode::invalid_argument, "identity", [&] { scorer.add(frame, pose); });
  const std::vector<std::uint8_t> labels{3};
  expect_error(ErrorCode::invalid_argument, "", [&] {
    scorer.set({{0, 0, 0}, {1, 1, 1}}, labels);
  });
  expect_error(ErrorCode::invalid_argument, "", [&] { scorer.forget({{kNan, 0, 0}, {1, 1, 1}}); });
  EXPECT_EQ(scorer.add(DepthFrame{2, 2, std::vector<float>(4, 1.0F)}, pose).verdict,
            FrameVerdict::wrong_size);
  expect_error(ErrorCode::invalid_argument, "inside out along x", [&] {
    scorer.forget({{1, 0, 0}, {0, 1, 1}});
  });
  DepthFrame millimetres = scene.see(pose);
  for (float& z : millimetres.depth) z *= 1000;
  EXPECT_EQ(scorer.add(millimetres, pose).verdict, FrameVerdict::not_metres);
  for (float& z : millimetres.depth) z = 450;
  EXPECT_EQ(scorer.add(millimetres, pose).verdict, FrameVerdict::not_metres);
  Pose lost = pose;
  lost.m[0] = kNan;
  EXPECT_EQ(scorer.add(scene.see(pose), lost).verdict, FrameVerdict::lost_pose);
  EXPECT_EQ(scorer.add(scene.see(pose), look_at({9, 9, 9}, {20, 20, 20})).verdict,
            FrameVerdict::outside);
  // Changes that change nothing keep the scene.
  EXPECT_EQ(scorer.forget({{9, 9, 9}, {10, 10, 10}}), 0U);
  EXPECT_EQ(scorer.grid().content_hash(), hash);
  EXPECT_EQ(scorer.scene(), before);
}

TEST(ViewScorer, RefusesSettingsAtOnce) {
  const ScorerScene scene;
  const auto refuses = [&](const std::string& part, const auto& change) {
    ScorerConfig config = scene.config();
    change(config);
    expect_error(ErrorCode::invalid_argument, part,
                 [&] { const ViewScorer never(scene.sensor, config); });
  };
  refuses("voxel", [](ScorerConfig& c) { c.voxel_size = 0; });
  refuses("metres", [](ScorerConfig& c) { c.voxel_size = 0.5; });
  refuses("trace", [](ScorerConfig& c) { c.gain.criterion = Criterion::trace; });
  refuses("stride", [](ScorerConfig& c) { c.gain.pixel_stride = 0; });
  refuses("clearance", [](ScorerConfig& c) { c.clearance = -1; });
  refuses("plane", [](ScorerConfig& c) { c.support_plane = kNan; });
  refuses("angle", [](ScorerConfig& c) { c.jump_edges->angle = 2; });
  refuses("coarsest", [](ScorerConfig& c) { c.coarsest = 4; });
  refuses("gain.prior_sigma", [](ScorerConfig& c) { c.gain.prior_sigma = 0.01; });
  Sensor sensor = scene.sensor;
  sensor.camera.fx = -1;
  expect_error(ErrorCode::invalid_argument, "fx",
               [&] { const ViewScorer never(sensor, scene.config()); });
  expect_error(ErrorCode::io, "none.vdb",
               [&] { (void)ViewScorer::load("none.vdb", scene.sensor, scene.config()); });
}

// One far value may stand for no reading.
TEST(ViewScorer, AFarValueBesideNearReadingsIsNoOtherUnit) {
  const ScorerScene scene;
  ViewScorer scorer(scene.sensor, scene.config(), {1});
  DepthFrame frame = scene.see(scene.poses[0]);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    if (i % 40 != 0) frame.depth[i] = 65.535F;
  }
  EXPECT_NE(scorer.add(frame, scene.poses[0]).verdict, FrameVerdict::not_metres);
  frame.depth[1] = 70;
  EXPECT_EQ(scorer.add(frame, scene.poses[0]).verdict, FrameVerdict::not_metres);
}

// What was handed out stays as it was, and a scorer can be moved.
TEST(ViewScorer, ScenesThatWereHandedOutStay) {
  const ScorerScene scene;
  ViewScorer scorer(scene.sensor, scene.config(), {1});
  const Pose& pose = scene.poses[0];
  const auto evaluator = scorer.evaluator();
  const std::vector<ViewGain> before = evaluator->evaluate(scene.poses);
  scorer.add(scene.see(pose), pose);
  ViewScorer moved = std::move(scorer);
  moved.add(scene.see(scene.poses[3]), scene.poses[3]);
  expect_same(evaluator->evaluate(scene.poses), before);
  EXPECT_NE(moved.evaluator(), evaluator);
  const BeliefGrid after = moved.grid_after({pose, {scene.see(pose, 7)}, {}});
  EXPECT_NE(after.content_hash(), moved.grid().content_hash());
  EXPECT_EQ(moved.grid().views().size(), 2U);
  EXPECT_EQ(after.views().size(), 3U);
  expect_error(ErrorCode::invalid_argument, "lost_pose", [&] {
    Pose lost = pose;
    lost.m[3] = kNan;
    (void)moved.grid_after({lost, {scene.see(pose)}, {}});
  });
}

// The first reading of a voxel holds.
TEST(ViewScorer, WithoutRefinementLaterReadingsAreIgnored) {
  const ScorerScene scene;
  ScorerConfig config = scene.config();
  config.refine = false;
  config.occupancy = IntegrationConfig::Occupancy::literal;  // readings hit where they lie
  ViewScorer scorer(scene.sensor, config, {1});
  const Pose& pose = scene.poses[0];
  scorer.add(scene.see(pose, 1), pose);
  const std::uint64_t hits = scorer.grid().statistics().hits;
  scorer.add(scene.see(pose, 1), pose);
  EXPECT_EQ(scorer.grid().statistics().hits, hits);
  EXPECT_GT(hits, 100U);
}

}  // namespace
}  // namespace viewgain
