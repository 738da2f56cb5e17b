// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What frames say of the hazard: against a fine walk and a world of which the rate is known.

#include "viewgain/grid/hazard_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 0.01;
constexpr double kSigma = 1e-4;

/// An unknown cube of 0.4 m, but for a known spot: else no surface is known and nothing is counted.
/// By default it lies in a corner, where it is far from all rays.
BeliefGrid unknown_cube(const Pose& T_world_grid = {}, Index3 spot = {-18, -18, -18}) {
  BeliefGrid grid({kVoxel, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, T_world_grid, 0.01});
  const float information = 3 / static_cast<float>(0.005 * 0.005);
  grid.set(spot, 2.0F, Belief{{information, information, information, 0, 0, 0}, {0, 0, 0}, 3});
  return grid;
}

Sensor looking() {
  Sensor sensor = test::small_sensor(64, 48);
  sensor.camera.fx = sensor.camera.fy = 150;
  sensor.noise = ConstantNoise{kSigma, kSigma};
  sensor.min_range = 0.1;
  sensor.max_range = 2.0;
  return sensor;
}

const Pose kFromFront = look_at({0.03, -0.6, 0.05}, {0, 0, 0}, {0, 0, 1});

TEST(HazardCalibration, CountsWhatAFineWalkCounts) {
  Sensor sensor = looking();  // so few pixels that all are followed
  sensor.camera.width = 32, sensor.camera.height = 24;
  sensor.camera.fx = sensor.camera.fy = 75;
  sensor.camera.cx = 15.5, sensor.camera.cy = 11.5;
  std::size_t cases = 0, classes = 0;
  for (const bool turned : {false, true}) {
    const Pose T_world_grid =
        turned ? look_at({0.02, -0.01, 0.03}, {0.3, 1, 0.2}, {0, 0.1, 1}) : Pose{};
    for (const double depth : {0.7, 0.55, 10.0}) {  // [m]; the last is out of range
      BeliefGrid grid = unknown_cube(T_world_grid, {2, -8, 3});
      const HazardField field(grid.snapshot(), {.object_size = 0.35});
      const HazardProbe probe(grid.snapshot(), {.object_size = 0.35});
      const DepthFrame frame =
          test::see_plane(sensor, depth > 2 ? DepthFrame::kOutOfRange : static_cast<float>(depth));
      HazardCalibration(sensor).count(grid, probe, frame, kFromFront);

      // All pixels, in steps of a twentieth of a voxel.
      std::array<double, HazardCounters::kClasses> expected{}, met{};
      const double lambda = field.model().decay_length;
      double all = 0;
      for (const Vector3d& ray : sensor.camera.ray_table()) {
        const Vector3d u = kFromFront.rotation() * ray.normalized();
        const double range = depth > 2 ? sensor.max_range : depth * ray.norm() - 3 * kSigma;
        const double step = kVoxel / 20;
        for (double t = sensor.min_range; t < range; t += step) {
          const auto v = grid.index_of(kFromFront.translation() + t * u);
          if (!v || grid.state(*v) != VoxelState::unknown) continue;
          const double d = field.distance(*v);  // has a test of its own
          const double rate = field.start_rate(*v) * step;
          expected[HazardCounters::class_of(d / lambda)] += rate;
          all += rate;
        }
        if (depth > 2) continue;
        const auto v = grid.index_of(kFromFront.translation() + depth * ray.norm() * u);
        if (v && grid.state(*v) == VoxelState::unknown) {
          met[HazardCounters::class_of(field.distance(*v) / lambda)] += 1;
        }
      }
      for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
        const HazardCounters::Class& c = grid.hazard_counters().classes[k];
        // A frame by which fewer than ten meetings are expected counts for less.
        const double scale = HazardCounters::kFrame / std::max(all, 10.0);
        EXPECT_NEAR(static_cast<double>(c.expected), expected[k] * scale,
                    0.03 * HazardCounters::kFrame)
            << k;
        EXPECT_NEAR(static_cast<double>(c.met), met[k] * scale, 0.02 * (1 + met[k] * scale)) << k;
        classes += c.expected > 0;
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 6U);
  EXPECT_EQ(classes, 36U);
}

TEST(HazardCalibration, FindsTheRateOfAWorldThatHasOne) {
  // Surface at a rate of 3 times the model's beyond the cut, wherever a ray passes.
  const Sensor sensor = looking();
  std::mt19937 random(5);
  BeliefGrid grid = unknown_cube();
  const HazardField field(grid.snapshot(), {.object_size = 0.35});
  const HazardProbe probe(grid.snapshot(), {.object_size = 0.35});
  const double rate = 3 * field.model().far_rate;
  const std::size_t far = HazardCounters::kClasses - 1;
  int frames = 0;
  for (; frames < 12; ++frames) {
    DepthFrame frame = test::see_plane(sensor, DepthFrame::kOutOfRange);
    const std::vector<Vector3d> rays = sensor.camera.ray_table();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Vector3d u = kFromFront.rotation() * rays[i].normalized();
      // Into the cube through y = -0.2, the side that all rays meet.
      const double entry = (-0.2 - kFromFront.translation().y()) / u.y();
      const double range = entry + std::exponential_distribution<double>(rate)(random);
      const Vector3d p = kFromFront.translation() + range * u;
      if ((p.array().abs() < 0.2).all()) {
        frame.depth[i] = static_cast<float>(range / rays[i].norm());
      }
    }
    HazardCalibration(sensor).count(grid, probe, frame, kFromFront);
  }
  EXPECT_EQ(frames, 12);
  const HazardCounters::Class& c = grid.hazard_counters().classes[far];
  EXPECT_NEAR(static_cast<double>(c.met) / static_cast<double>(c.expected), 3.0, 0.3);
  // The field follows, with the prior's pull, and never rises with the distance.
  const HazardField after(grid.snapshot(), {.object_size = 0.35});
  EXPECT_GT(grid.hazard_counters().factor(far), 2.6);
  EXPECT_NEAR(after.far_rate() / field.far_rate(), 2.7, 0.3);
  std::size_t compared = 0;
  for (std::int32_t x = -18; x < 20; ++x, ++compared) {
    EXPECT_LE(after.rate({x + 1, -18, -18}), after.rate({x, -18, -18}));
    EXPECT_GE(after.rate({x, -18, -18}), field.rate({x, -18, -18}));
  }
  EXPECT_EQ(compared, 38U);
  // Rates that are given stay what they are.
  const HazardConfig::Model given{20.0, 0.03, 0.5};
  EXPECT_EQ(HazardField(grid.snapshot(), {.model = given}).far_rate(), 0.5F);
  EXPECT_EQ(HazardField(grid.snapshot(), {.object_size = 0.35, .calibrated = false}).far_rate(),
            field.far_rate());
}

// Where a class meets four times as much as the nearer ones, rates step up nowhere; the far rate's
// share may grow a little.
TEST(HazardCalibration, RatesDoNotStepUpWithTheDistance) {
  BeliefGrid grid = unknown_cube();
  HazardCounters counters;
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    counters.classes[k].expected = 1'000'000'000;
    counters.classes[k].met = k < 2 ? 1'000'000'000 : 4'000'000'000;
  }
  grid.set_hazard_counters(counters);
  const HazardField field(grid.snapshot(), {.object_size = 1.4});
  for (std::int32_t x = -18; x < 20; ++x) {
    EXPECT_LE(field.rate({x + 1, -18, -18}), 1.01F * field.rate({x, -18, -18})) << x;
  }
}

TEST(HazardCalibration, EarlierFramesFade) {
  const Sensor sensor = looking();
  const DepthFrame frame = test::see_plane(sensor, 0.6F);
  BeliefGrid grid = unknown_cube();
  const HazardProbe probe(grid.snapshot(), {.object_size = 0.35});
  const HazardCalibration calibration(sensor);
  calibration.count(grid, probe, frame, kFromFront);
  const HazardCounters once = grid.hazard_counters();
  for (int i = 1; i < 40; ++i) calibration.count(grid, probe, frame, kFromFront);
  std::size_t counted = 0;
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    const HazardCounters::Class &c = grid.hazard_counters().classes[k], &first = once.classes[k];
    const auto expect_faded = [](std::int64_t now, std::int64_t then) {
      const double all = static_cast<double>(then) / 0.3;
      EXPECT_NEAR(static_cast<double>(now), all, 40 + 1e-6 * all);
    };
    expect_faded(c.expected, first.expected);
    expect_faded(c.met, first.met);
    counted += first.met > 0;
  }
  EXPECT_GE(counted, 1U);
}

TEST(HazardCalibration, PosesThatAreALittleOffAreMended) {
  const Sensor sensor = looking();
  BeliefGrid mended = unknown_cube({}, {0, 0, 0}), grid = unknown_cube({}, {0, 0, 0});
  const HazardProbe probe(grid.snapshot(), {.object_size = 0.35});
  Eigen::Matrix3d R = kFromFront.rotation();
  R.col(0) += 9e-4 * R.col(1);
  const Pose off(R, kFromFront.translation());
  const DepthFrame frame = test::see_plane(sensor, 0.6F);
  HazardCalibration(sensor).count(mended, probe, frame, orthonormalized(off));
  HazardCalibration(sensor).count(grid, probe, frame, off);
  EXPECT_EQ(grid.hazard_counters(), mended.hazard_counters());
  EXPECT_FALSE(grid.hazard_counters().empty());
  test::expect_error(ErrorCode::invalid_argument, "rigid", [&] {
    HazardCalibration(sensor).count(grid, probe, frame, Pose(2 * R, off.translation()));
  });
}

TEST(HazardCalibration, CountsTheSameOnAnyNumberOfThreads) {
  std::size_t cases = 0;
  for (const Index3 size : {Index3{64, 48, 0}, Index3{61, 5, 0}, Index3{7, 300, 0}}) {
    Sensor sensor = looking();
    sensor.camera.width = size.x, sensor.camera.height = size.y;
    sensor.camera.cx = (size.x - 1) / 2.0, sensor.camera.cy = (size.y - 1) / 2.0;
    const DepthFrame frame = test::see_plane(sensor, 0.6F);
    std::optional<HazardCounters> alone;
    for (const int threads : {1, 2, 5}) {
      BeliefGrid grid = unknown_cube({}, {0, 0, 0});
      const HazardProbe probe(grid.snapshot(), {.object_size = 0.35});
      HazardCalibration(sensor, {}, {.num_threads = threads}).count(grid, probe, frame, kFromFront);
      EXPECT_FALSE(grid.hazard_counters().empty());
      if (!alone) alone = grid.hazard_counters();
      EXPECT_EQ(grid.hazard_counters(), *alone);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 9U);
}

TEST(HazardCalibration, WhatSaysNothing) {
  const Sensor sensor = looking();
  const HazardCalibration calibration(sensor);
  BeliefGrid grid = unknown_cube();
  const HazardField field(grid.snapshot(), {.object_size = 0.35});
  const HazardProbe probe(grid.snapshot(), {.object_size = 0.35});
  calibration.count(grid, probe, test::see_plane(sensor, DepthFrame::kInvalid), kFromFront);
  EXPECT_TRUE(grid.hazard_counters().empty());
  // NaN is no reading, as at integration.
  calibration.count(grid, probe, test::see_plane(sensor, std::numeric_limits<float>::quiet_NaN()),
                    kFromFront);
  EXPECT_TRUE(grid.hazard_counters().empty());
  // What is given is not what is counted against: other scenes of the map would be misled.
  for (const HazardConfig& given :
       {constant_hazard(0.5, grid), HazardConfig{.model = HazardConfig::Model::for_size(0.3)},
        HazardConfig{.calibrated = false}}) {
    const HazardProbe fixed(grid.snapshot(), given);
    EXPECT_FALSE(fixed.follows_counters());
    calibration.count(grid, fixed, test::see_plane(sensor, 0.6F), kFromFront);
    EXPECT_TRUE(grid.hazard_counters().empty());
  }
  EXPECT_TRUE(field.follows_counters());
  DepthFrame turned = test::see_plane(sensor, 0.6F);
  std::swap(turned.width, turned.height);
  test::expect_error(ErrorCode::invalid_argument, "px",
                     [&] { calibration.count(grid, probe, turned, kFromFront); });
  // Readings of a table meet nothing, but pass what is before it.
  const Pose down = look_at({0, 0, 0.6}, {0, 0, 0}, {0, 1, 0});
  HazardCalibration(sensor, 0.0).count(grid, probe, test::see_plane(sensor, 0.6F), down);
  std::int64_t expected = 0;
  for (const HazardCounters::Class& c : grid.hazard_counters().classes) {
    EXPECT_EQ(c.met, 0);
    expected += c.expected;
  }
  EXPECT_GT(expected, 0);
  // Without known surface there is no distance.
  BeliefGrid empty({kVoxel, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
  calibration.count(empty, HazardProbe(empty.snapshot()), test::see_plane(sensor, 0.6F),
                    kFromFront);
  EXPECT_TRUE(empty.hazard_counters().empty());
  // A field of another map.
  test::expect_error(ErrorCode::invalid_argument, short_text(2 * kVoxel).c_str(), [&] {
    const BeliefGrid other({2 * kVoxel, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
    calibration.count(grid, HazardProbe(other.snapshot()), test::see_plane(sensor, 0.6F),
                      kFromFront);
  });
  test::expect_error(ErrorCode::invalid_argument, "2 x 2 px", [&] {
    calibration.count(grid, probe, DepthFrame{2, 2, std::vector<float>(4, 0.6F)}, kFromFront);
  });
}

TEST(HazardCalibration, IsPartOfTheMap) {
  const test::TemporaryFolder dir;
  BeliefGrid grid = unknown_cube();
  const std::string without = grid.content_hash();
  HazardCounters counters;
  counters.classes[2] = {123, 4'567'890'123};
  grid.set_hazard_counters(counters);
  EXPECT_NE(grid.content_hash(), without);
  EXPECT_EQ(grid.clone().hazard_counters(), counters);
  EXPECT_EQ(grid.snapshot().hazard, counters);
  save_vdb(grid, dir.path() / "map.vdb");
  const BeliefGrid loaded = load_vdb(dir.path() / "map.vdb");
  EXPECT_EQ(loaded.hazard_counters(), counters);
  EXPECT_EQ(loaded.content_hash(), grid.content_hash());
  grid.set_hazard_counters({});
  EXPECT_EQ(grid.content_hash(), without);
  counters.classes[5].met = -1;
  test::expect_error(ErrorCode::invalid_argument, "a hazard counter is -1; it must be in 0..2^40",
                     [&] { grid.set_hazard_counters(counters); });
}

}  // namespace
}  // namespace viewgain
