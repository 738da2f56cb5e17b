// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Classic gains in closed form, what they refuse, and that threads and histories change no bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "apps/literature/classic_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {
using Status = ViewGain::Status;

using test::kExactVoxel;

constexpr double kLn2 = 0.69314718055994531;

/// One ray, along the optical axis.
Sensor one_ray() {
  Sensor sensor = test::lattice_sensor(1, 1);
  sensor.camera.cx = sensor.camera.cy = 0;
  return sensor;
}

/// 16 x 3 x 3 voxels, all unknown but those of its middle row that are given log-odds from x = 0
/// on.
BeliefGrid row_map(const std::vector<std::optional<float>>& log_odds) {
  BeliefGrid grid(
      {kExactVoxel, {{0, 0, 0}, {16 * kExactVoxel, 3 * kExactVoxel, 3 * kExactVoxel}}, {}, 0.02});
  for (std::size_t x = 0; x < log_odds.size(); ++x) {
    if (log_odds[x]) grid.set({static_cast<int>(x), 1, 1}, *log_odds[x]);
  }
  return grid;
}

/// Along the middle row from 4 voxels before it.
Pose row_pose() { return test::axis_pose({-4, 1.5, 1.5}, 0, true); }

std::vector<double> gains_of(const BeliefGrid& grid, const Sensor& sensor, const Pose& pose,
                             std::vector<ClassicGain> gains = test::all_classic_gains()) {
  const auto map = ClassicMap::build(
      VoxelScene::build(grid), grid,
      grid.views().empty() ? std::nullopt : std::optional(Acquisition{sensor, 8 * kExactVoxel}));
  const ClassicConfig config{.gains = std::move(gains)};
  return ClassicGainEvaluator(map, sensor, config).evaluate(std::vector<Pose>{pose});
}

double entropy(double p) { return -p * std::log(p) - (1 - p) * std::log(1 - p); }
double probability(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

// Visibility and entropies of a ray are summed in single precision.
constexpr double kSingle = 3e-7;

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ClassicGains, NamesAreThereAndBack) {
  ASSERT_EQ(classic_gain_names().size(), 10U);
  for (const std::string& name : classic_gain_names()) {
    EXPECT_EQ(classic_gain_name(parse_classic_gain(name)), name);
    EXPECT_FALSE(classic_gain_unit(parse_classic_gain(name)).empty());
  }
  const std::string text = error_of([] { (void)parse_classic_gain("rear_side"); });
  for (const std::string& name : classic_gain_names()) EXPECT_NE(text.find(name), text.npos);
}

// Surface that a ray enters before min_range is not measured, and not seen through.
TEST(ClassicGains, ASurfaceNearerThanMinRangeLeavesNothing) {
  BeliefGrid grid = row_map({-0.4F, 2.0F, -0.4F, {}, {}, 2.0F});
  grid.append_view(test::axis_pose({20, 1.5, 1.5}, 0, false));
  const Sensor sensor = one_ray();
  EXPECT_GT(gains_of(grid, sensor, row_pose())[0], 0);
  for (const double min_range : {5.1, 5.9, 6.0, 6.5, 8.5}) {
    ClassicConfig config{.gains = test::all_classic_gains(), .min_range = min_range * kExactVoxel};
    const auto map =
        ClassicMap::build(VoxelScene::build(grid), grid, Acquisition{sensor, 8 * kExactVoxel});
    const auto gains =
        ClassicGainEvaluator(map, sensor, config).evaluate(std::vector<Pose>{row_pose()});
    for (std::size_t g = 0; g < gains.size(); ++g) {
      EXPECT_EQ(gains[g], 0) << classic_gain_names()[g] << " from " << min_range;
    }
  }
}

TEST(ClassicGains, ARowWithASurfaceHasItsClosedForm) {
  // Two free, three unknown, one occupied, unknown ones behind. An earlier view came from there.
  BeliefGrid grid = row_map({-0.4F, -1.5F, {}, {}, {}, 2.0F});
  grid.append_view(test::axis_pose({20, 1.5, 1.5}, 0, false));
  const double p0 = probability(-0.4F), p1 = probability(-1.5F), p5 = probability(2.0F);
  const auto paper = gains_of(grid, one_ray(), row_pose());
  const double P2 = (1 - p0) * (1 - p1);
  const double unknown = P2 * kLn2 * 1.75;
  EXPECT_NEAR(paper[0], entropy(p0) + (1 - p0) * entropy(p1) + unknown + P2 / 8 * entropy(p5),
              kSingle);
  EXPECT_NEAR(paper[1], unknown, kSingle);
  EXPECT_NEAR(paper[2], (entropy(p0) + entropy(p1) + 3 * kLn2 + entropy(p5)) / 6, kSingle);
  EXPECT_EQ(paper[3], 1);
  EXPECT_NEAR(paper[4], unknown, kSingle);
  // The other view's ray has voxel 4 one step behind the surface, and so on; 2 * 8 is the most.
  EXPECT_NEAR(paper[5], 15 + 14 + 13, 1e-9);
  EXPECT_NEAR(paper[6], 0, 1e-12);  // every ray comes to what is hidden: f(0) + f(1)
  EXPECT_EQ(paper[8], 3);
  // Voxels 2 to 4 of the row and none beside it are passed; of these 4 is next to the surface but
  // has no free neighbour.
  EXPECT_EQ(paper[9], 0);
}

TEST(ClassicGains, PosesThatSeeNothing) {
  BeliefGrid grid = row_map({2.0F});
  const auto map = ClassicMap::build(VoxelScene::build(grid), grid);
  ClassicConfig config{.gains = {ClassicGain::occlusion_aware, ClassicGain::unknown_count,
                                 ClassicGain::average_entropy}};
  Pose bad = row_pose();
  bad.m[3] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Pose> poses{
      bad, test::axis_pose({0.5, 1.5, 1.5}, 0, true), test::axis_pose({-4, 1.5, 1.5}, 0, false),
      test::axis_pose({-1e7, 1.5, 1.5}, 0, true), test::axis_pose({5.5, 1.5, 1.5}, 0, true)};
  std::vector<double> gains(poses.size() * 3);
  std::vector<Status> statuses(poses.size());
  EXPECT_EQ(ClassicGainEvaluator(map, one_ray(), config).evaluate(poses, gains, statuses), 5U);
  EXPECT_EQ(statuses, (std::vector<Status>{Status::bad_pose, Status::camera_in_occupied, Status::ok,
                                           Status::ok, Status::ok}));
  for (std::size_t g = 0; g < 3; ++g) {
    EXPECT_TRUE(std::isnan(gains[g]));
    for (const std::size_t pose : {1U, 2U, 3U}) EXPECT_EQ(gains[pose * 3 + g], 0) << pose;
  }
  // From an unknown voxel: its half and ten more.
  EXPECT_EQ(gains[4 * 3 + 1], 11);
  std::vector<double> none;
  EXPECT_EQ(ClassicGainEvaluator(map, one_ray(), config).evaluate({}, none), 0U);
}

TEST(ClassicGains, RefuseWhatTheyCannotDo) {
  const BeliefGrid grid = row_map({});
  const auto scene = VoxelScene::build(grid);
  const auto map = ClassicMap::build(scene, grid);
  const auto no_views = ClassicMap::build(scene, grid, Acquisition{one_ray(), 0.1});
  const auto refused = [&](const auto& of, const ClassicConfig& config) {
    return error_of([&] { (void)ClassicGainEvaluator(of, one_ray(), config); });
  };
  const auto expect = [](const std::string& text, const std::string& word) {
    EXPECT_NE(text.find(word), text.npos) << text;
  };
  expect(refused(map, {.gains = {ClassicGain::proximity_count}}), "sensor");
  expect(refused(map, {.gains = {ClassicGain::proximity_count}}), "proximity_count");
  expect(refused(no_views, {.gains = {ClassicGain::area_factor}}), "records no views");
  expect(refused(map, {}), "the list of gains is empty");
  const ClassicGain one = ClassicGain::unknown_count;
  expect(refused(map, {.gains = {one, one}}), "twice");
  expect(refused(nullptr, {.gains = {one}}), "require a map");
  expect(refused(map, {.gains = {one}, .pixel_stride = 0}), "stride must be at least 1, not 0");
  expect(refused(map, {.gains = {one}, .min_range = 2, .max_range = 1}),
         "min_range, 2 m, must be below max_range, 1 m");
  expect(refused(map, {.gains = {one}, .unknown_prior = 1.5}), "1.5");
  expect(error_of([&] { (void)ClassicMap::build(nullptr, grid); }), "require a scene");
  expect(error_of([&] {
           (void)ClassicMap::build(scene, row_map({}).clone(), Acquisition{one_ray(), 99});
         }),
         "99");
  BeliefGrid other({kExactVoxel, {{0, 0, 0}, {1, 1, 1}}, {}, 0.02});
  expect(error_of([&] { (void)ClassicMap::build(scene, other); }), "workspaces");
  const ClassicGainEvaluator evaluator(map, one_ray(), {.gains = {one}});
  std::vector<double> room(3);
  expect(error_of([&] { evaluator.evaluate(std::vector<Pose>{row_pose()}, room); }), "room for 3");
}

TEST(ClassicGains, ThreadsAndHistoryChangeNoBit) {
  test::Random random(8);
  test::RandomMap made = test::random_map(test::MapFamily::salt_and_pepper_30, random);
  test::vary_log_odds(made.grid, random);
  const Sensor sensor = test::random_sensor(made.grid, random);
  const std::vector<Pose> poses = test::random_poses(made, 40, random);
  for (std::size_t i = 0; i < 3; ++i) made.grid.append_view(poses[i]);
  const Acquisition acquisition{sensor, 6 * made.grid.voxel_size()};
  const auto map_of = [&](const BeliefGrid& grid, int threads) {
    return ClassicMap::build(VoxelScene::build(grid), grid, acquisition, {threads});
  };
  const ClassicConfig config{.gains = test::all_classic_gains()};
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
      return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
  };
  const ClassicGainEvaluator alone(map_of(made.grid, 1), sensor, config, {1});
  const auto expected = alone.evaluate(poses);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0);
  for (const int threads : {2, 3}) {
    const ClassicGainEvaluator many(map_of(made.grid, threads), sensor, config, {threads});
    EXPECT_TRUE(same(many.evaluate(poses), expected)) << threads;
    EXPECT_EQ(many.num_threads(), threads);
  }
  // One gain alone is what it is among the others.
  for (std::size_t g = 0; g < 10; ++g) {
    const ClassicConfig one{.gains = {config.gains[g]}};
    const auto gains = ClassicGainEvaluator(map_of(made.grid, 1), sensor, one, {1}).evaluate(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_NEAR(gains[i], expected[i * 10 + g], 1e-9 * std::abs(expected[i * 10 + g]));
    }
  }
  // A map that has grown, by an evaluator that knew it before.
  BeliefGrid grown = made.grid.clone();
  const Index3 low = grown.min_index();
  for (int i = 0; i < 12; ++i) grown.set({low.x + i, low.y + i, low.z + i}, 1.0F);
  const auto after = map_of(grown, 1);
  const auto fresh = ClassicGainEvaluator(after, sensor, config, {1}).evaluate(poses);
  EXPECT_TRUE(same(alone.with_map(after).evaluate(poses), fresh));
  EXPECT_FALSE(same(fresh, expected));
  EXPECT_TRUE(same(alone.evaluate(poses), expected));
}

TEST(ClassicGains, AStopLeavesTheRestUnscored) {
  const BeliefGrid grid = row_map({});
  const auto map = ClassicMap::build(VoxelScene::build(grid), grid);
  const ClassicGainEvaluator evaluator(map, one_ray(), {.gains = {ClassicGain::unknown_count}},
                                       {1});
  const std::vector<Pose> poses(100, row_pose());
  std::vector<double> gains(100);
  BatchControl control;
  int asked = 0;
  control.is_cancelled = [&] { return ++asked > 10; };
  const std::size_t done = evaluator.evaluate(poses, gains, {}, control);
  EXPECT_EQ(done, 10U);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(std::isnan(gains[i]), i >= done) << i;
}

}  // namespace
}  // namespace viewgain
