// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains of the user's own that see what rays pass: what they are given, against a slab worked out
// by hand and the oracle's walk through random maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "core/expect_error.hpp"
#include "oracle/gain.hpp"
#include "oracle/surface.hpp"
#include "oracle/walk.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

/// Keeps what it is given, and says how many voxels that was.
class Keeping : public RunMeasure {
 public:
  double measure(const Pose& T_world_camera, std::span<const RunMeasure::Run> runs) const override {
    const std::lock_guard lock(mutex_);
    kept_.emplace_back(T_world_camera, std::vector<RunMeasure::Run>(runs.begin(), runs.end()));
    return static_cast<double>(runs.size());
  }
  [[nodiscard]] const std::vector<RunMeasure::Run>& of(const Pose& pose) const {
    for (const auto& [at, runs] : kept_) {
      if (at == pose) return runs;
    }
    throw std::out_of_range("no such pose");
  }
  [[nodiscard]] std::size_t size() const { return kept_.size(); }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<Pose, std::vector<RunMeasure::Run>>> kept_;
};

TEST(RunMeasure, PassesASlabToTheWallBehindIt) {
  constexpr double V = test::kExactVoxel;
  constexpr double kRate = 3;  // [1/m]
  GridConfig config;
  config.voxel_size = V;
  config.workspace = test::sparse_map({32, 16, 16}, {}).workspace();
  config.prior_sigma = 0.5 * V;
  BeliefGrid grid(config);
  const Index3 base = grid.min_index();
  for (int x = 0; x < 32; ++x) {
    if (x >= 8 && x < 20) continue;  // unknown
    for (int y = 0; y < 16; ++y) {
      for (int z = 0; z < 16; ++z) {
        const Index3 voxel{base.x + x, base.y + y, base.z + z};
        if (x == 20) {
          grid.set(voxel, 0.85F, Belief{{1e6F, 1e6F, 1e6F, 0, 0, 0}, {}, 7});
        } else {
          grid.set(voxel, -0.4F);
        }
      }
    }
  }
  const auto scene =
      VoxelScene::build(grid, {}, {},
                        {.model = HazardConfig::Model::constant(
                             kRate, 4 * V / HazardConfig::Model::for_size(1).decay_length)});
  Sensor sensor = test::lattice_sensor(1, 1);
  const Pose pose = test::axis_pose({-30, 8.5, 8.5}, 0, true);
  for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
    const GainEvaluator evaluator(scene, sensor, {.model = model});
    const Keeping own;
    std::vector<double> result(1);
    EXPECT_EQ(evaluator.evaluate(std::span(&pose, 1), result, own), 1U);
    EXPECT_EQ(result[0], 13);
    const std::vector<RunMeasure::Run>& runs = own.of(pose);
    ASSERT_EQ(runs.size(), 13U);
    for (int i = 0; i < 13; ++i) {
      const RunMeasure::Run& run = runs[static_cast<std::size_t>(i)];
      EXPECT_EQ(run.voxel.x - base.x, 8 + i);
      EXPECT_EQ(run.ray, 0U);
      EXPECT_NEAR(run.begin, (38 + i) * V, 1e-5 * V);
      EXPECT_NEAR(run.end, (i < 12 ? 39 + i : 50) * V, 1e-5 * V);
      EXPECT_NEAR(run.rate, i < 12 ? kRate : 0.0, 1e-5);
      EXPECT_EQ(run.state, i < 12 ? VoxelState::unknown : VoxelState::occupied);
      ASSERT_EQ(run.belief != nullptr, i == 12);
      EXPECT_NEAR(run.direction[0], 1, 1e-6);
    }
    EXPECT_EQ(runs.back().belief->hits, 7U);
  }
}

// Of one ray, [voxels].
struct Passed {
  std::map<std::tuple<int, int, int>, double> lengths;
  std::optional<Index3> end;
};

Passed expected_of(const oracle::DenseMap& map, const oracle::Ray& ray, double min_range,
                   double max_range) {
  Passed passed;
  oracle::walk(map, ray, [&](Index3 voxel, double in, double out) {
    if (oracle::blocks(map, ray, {.min_range = min_range}, voxel, in)) return true;
    const double begin = std::max(in, min_range), end = std::min(out, max_range);
    if (!(end > begin)) return in > max_range;
    const VoxelState state = map.state(voxel);
    if (state == VoxelState::occupied) {
      passed.end = voxel;
      return true;
    }
    if (state == VoxelState::unknown) passed.lengths[{voxel.x, voxel.y, voxel.z}] = end - begin;
    return false;
  });
  return passed;
}

class Runs : public testing::TestWithParam<test::MapFamily> {};

TEST_P(Runs, AreTheVoxelsOfTheOraclesWalk) {
  test::Random random(77 + static_cast<unsigned>(GetParam()));
  std::size_t rays = 0, others = 0, ends = 0, voxels = 0;
  int maps = 0;
  for (; maps < 4; ++maps) {
    const test::RandomMap made = test::random_map(GetParam(), random);
    const oracle::DenseMap map(made.grid);
    const Sensor sensor = test::random_sensor(made.grid, random);
    const double V = made.grid.voxel_size();
    const auto scene = VoxelScene::build(made.grid);
    const GainConfig config{.pixel_stride = 2};
    const GainEvaluator evaluator(scene, sensor, config, {.num_threads = 2});
    const std::vector<Pose> poses = test::random_poses(made, 4, random);
    const Keeping own;
    std::vector<double> results(poses.size());
    EXPECT_EQ(evaluator.evaluate(poses, results, own), poses.size());
    const Eigen::Matrix3d R_world_grid = made.grid.T_world_grid().rotation();
    for (std::size_t p = 0; p < poses.size(); ++p) {
      if (evaluator.evaluate(poses[p]).status == ViewGain::Status::camera_in_occupied) {
        EXPECT_EQ(results[p], 0);
        continue;
      }
      const std::vector<RunMeasure::Run>& runs = own.of(poses[p]);
      EXPECT_EQ(results[p], static_cast<double>(runs.size()));
      const std::vector<oracle::Ray> expected_rays = oracle::view_rays(
          made.grid.T_world_grid(), V, sensor.camera, config.pixel_stride, poses[p]);
      std::vector<Passed> passed(expected_rays.size());
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const RunMeasure::Run& run = runs[i];
        const bool follows = i > 0 && runs[i - 1].ray == run.ray;
        Passed& ray = passed.at(run.ray);
        EXPECT_EQ(follows, !ray.lengths.empty() || ray.end) << "a ray is in one piece";
        if (follows) {
          EXPECT_EQ(runs[i - 1].state, VoxelState::unknown);
          EXPECT_GE(run.begin, runs[i - 1].end);
          EXPECT_EQ(run.direction, runs[i - 1].direction);
        }
        EXPECT_EQ(run.state, made.grid.state(run.voxel));
        const Eigen::Vector3d direction(run.direction.data());
        EXPECT_LT((direction - R_world_grid * expected_rays.at(run.ray).direction).norm(), 1e-6);
        if (run.state == VoxelState::occupied) {
          EXPECT_EQ(run.begin, run.end);
          ray.end = run.voxel;
        } else {
          EXPECT_FLOAT_EQ(static_cast<float>(run.rate), scene->hazard().rate(run.voxel));
          ray.lengths[{run.voxel.x, run.voxel.y, run.voxel.z}] = (run.end - run.begin) / V;
        }
      }
      voxels += runs.size();
      for (std::size_t r = 0; r < expected_rays.size(); ++r, ++rays) {
        Passed expected =
            expected_of(map, expected_rays[r], sensor.min_range / V, sensor.max_range / V);
        double off = 0;
        for (const auto& [voxel, length] : passed[r].lengths) expected.lengths[voxel] -= length;
        for (const auto& [voxel, length] : expected.lengths) off += std::abs(length);
        ends += expected.end ? 1 : 0;
        // Rounding may send a ray past an edge.
        if (passed[r].end != expected.end || off > 5e-3) ++others;
      }
    }
  }
  EXPECT_EQ(maps, 4);
  EXPECT_GT(rays, 1000U);
  EXPECT_GT(voxels, rays / 10);
  EXPECT_GT(ends, 10U);
  EXPECT_LE(others, 2 + rays / 200) << rays;
}

INSTANTIATE_TEST_SUITE_P(Maps, Runs,
                         testing::Values(test::MapFamily::salt_and_pepper_1,
                                         test::MapFamily::salt_and_pepper_30,
                                         test::MapFamily::tiles_8, test::MapFamily::odd_and_far,
                                         test::MapFamily::rotated),
                         test::family_name);

class Failing : public RunMeasure {
 public:
  double measure(const Pose&, std::span<const RunMeasure::Run>) const override {
    throw std::out_of_range("the user's own");
  }
};

TEST(RunMeasure, SameForAnyNumberOfThreadsAndErrorsReachTheCaller) {
  test::Random random(5);
  const test::RandomMap made = test::random_map(test::MapFamily::rotated, random);
  const Sensor sensor = test::random_sensor(made.grid, random);
  std::vector<Pose> poses = test::random_poses(made, 30, random);
  poses[3].m[0] = std::numeric_limits<double>::quiet_NaN();
  const auto scene = VoxelScene::build(made.grid);
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 3}) {
    const GainEvaluator evaluator(scene, sensor, test::kPaper, {.num_threads = threads});
    const Keeping own;
    results.emplace_back(poses.size());
    EXPECT_EQ(evaluator.evaluate(poses, results.back(), own), poses.size());
    EXPECT_LT(own.size(), poses.size());
    EXPECT_THROW(evaluator.evaluate(poses, results.back(), Failing()), std::out_of_range);
    EXPECT_EQ(evaluator.evaluate(poses, results.back(), own), poses.size());
    results.back().pop_back();
    test::expect_error(ErrorCode::invalid_argument, "30 poses, but the array has room for 29",
                       [&] { evaluator.evaluate(poses, results.back(), own); });
    EXPECT_TRUE(std::isnan(results.back()[3]));
    results.back().erase(results.back().begin() + 3);
  }
  EXPECT_EQ(results[0], results[1]);
}

// Surface and combined gain of random maps against the double-precision oracle, under each
// instruction set.

using test::MapFamily;

constexpr int kMaps = test::kSlowBuild ? 6 : 40;
constexpr std::size_t kPosesPerMap = test::kSlowBuild ? 2 : 3;

/// Hazards of any size of cell, some the same everywhere, some from elsewhere.
HazardConfig random_hazard(const BeliefGrid& grid, int number, test::Random& random) {
  const double cell = grid.voxel_size() * (1 << number % 4);
  HazardConfig config;
  config.model = {test::uniform(random, 0.0, 0.3) / grid.voxel_size(), 4 * cell,
                  test::uniform(random, 0.0, 0.02) / grid.voxel_size()};
  if (number % 5 == 1) config.model->near_rate = 0;
  if (number % 5 == 3) {
    HazardConfig::Volume volume;
    const Index3 base = grid.min_index();
    volume.box = VoxelBox::from_dims({base.x + 3, base.y + 2, base.z + 1},
                                     {std::min(24, grid.dims().x), 17, 20});
    volume.rates.resize(volume.box.volume());
    for (float& rate : volume.rates) {
      rate = static_cast<float>(test::uniform(random, 0.0, 0.3) / grid.voxel_size());
    }
    volume.outside = static_cast<float>(0.01 / grid.voxel_size());
    config.volume = std::make_shared<const HazardConfig::Volume>(std::move(volume));
  }
  return config;
}

GainConfig random_config(const BeliefGrid& grid, int number, test::Random& random) {
  GainConfig config;
  config.model = number % 2 == 0 ? GainModel::combined : GainModel::surface;
  config.pixel_stride = number % 3 == 1 ? 2 : 1;
  if (number % 4 == 2) {
    const Box all = grid.workspace();
    Box half = all;
    half.max[0] = 0.5 * (all.min[0] + all.max[0]) + 1e-4;
    config.weights = {{half, test::uniform(random, 0.0, 1.0)}};
  }
  return config;
}

class SurfaceOracle : public testing::TestWithParam<MapFamily> {};

TEST_P(SurfaceOracle, AgreesUnderEachInstructionSet) {
  test::Random random(4321 + static_cast<unsigned>(GetParam()));
  const std::vector<std::string> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  std::size_t checks = 0, gaining = 0, exact = 0;
  for (int i = 0; i < kMaps; ++i) {
    const test::RandomMap made = test::random_map(GetParam(), random);
    const oracle::DenseMap map(made.grid);
    const Sensor sensor = test::random_sensor(made.grid, random);
    const HazardConfig hazard_config = random_hazard(made.grid, i, random);
    const HazardField hazard(made.grid.snapshot(), hazard_config);
    const GainConfig config = random_config(made.grid, i, random);
    const Obstacles obstacles = i % 3 == 2 ? test::random_boxes(made.grid, random) : Obstacles{};
    for (const Pose& pose : test::random_poses(made, kPosesPerMap, random)) {
      const oracle::SurfaceValue expected =
          oracle::surface_value(made.grid, map, hazard, sensor, config, pose, obstacles);
      for (const std::string& isa : isas) {
        SCOPED_TRACE("map " + std::to_string(i) + ", " + isa);
        const test::ScopedIsa scoped(isa);
        const auto scene =
            VoxelScene::build(made.grid, {obstacles}, {.num_threads = 1}, hazard_config);
        const ViewGain actual =
            GainEvaluator(scene, sensor, config, {.num_threads = 1}).evaluate(pose);
        ++checks;
        if (actual.status == ViewGain::Status::camera_in_occupied) {
          EXPECT_EQ(actual.gain, 0.0);
          EXPECT_EQ(actual.area, 0.0);
          continue;
        }
        ASSERT_EQ(actual.status, ViewGain::Status::ok);
        gaining += expected.area > 0 ? 1 : 0;
        exact += std::abs(actual.area - expected.area) <= 1e-5 * expected.area ? 1 : 0;
        EXPECT_LE(std::abs(actual.area - expected.area),
                  1e-5 * expected.area + 0.1 * expected.pixel_area);
        if (config.model == GainModel::surface) {
          EXPECT_EQ(actual.gain, actual.area);
          EXPECT_TRUE(std::isnan(actual.refinement_saturated));
          continue;
        }
        EXPECT_LE(std::abs(actual.refinement_saturated - expected.refinement_saturated),
                  1e-5 * expected.refinement_saturated + expected.pixel_refinement);
        const double V = made.grid.voxel_size();
        EXPECT_LE(
            std::abs(actual.gain - expected.gain),
            1e-5 * expected.gain + expected.pixel_refinement + 10 * expected.pixel_area / (V * V));
      }
    }
  }
  EXPECT_EQ(checks, kMaps * kPosesPerMap * isas.size());
  EXPECT_GT(gaining, checks / 4);
  // The others have a ray that rounding sends another way.
  EXPECT_GT(exact, checks / 3);
}

// Rays from a corner of the lattice through others, which touch many voxels for no length: whatever
// the other rays of a packet are in meanwhile, a ray is worth what it is worth alone.
TEST(SurfaceLanes, ARayGainsTheSameAlone) {
  test::Random random(17);
  std::vector<Index3> unknown;
  const auto any = [&] { return test::uniform_int(random, 0, 31); };
  for (int i = 0; i < 20000; ++i) unknown.push_back({any(), any(), any()});
  BeliefGrid grid = test::sparse_map({32, 32, 32}, unknown, VoxelState::unknown);
  for (int i = 0; i < 20; ++i) {
    test::set_occupied_with_belief(grid, {any(), any(), any()}, random);
  }
  constexpr int kWidth = 9, kHeight = 7;
  for (int shift = 0; shift < 4; ++shift) {
    const auto scene =
        VoxelScene::build(grid, {}, {.num_threads = 1}, random_hazard(grid, 20 + shift, random));
    const auto area = [&](int width, int height, int u, int v, const Pose& pose) {
      Sensor sensor = test::lattice_sensor(width, height);
      sensor.camera.cx = test::lattice_sensor(kWidth, kHeight).camera.cx - u;
      sensor.camera.cy = test::lattice_sensor(kWidth, kHeight).camera.cy - v;
      const GainEvaluator evaluator(scene, sensor, {.model = GainModel::surface},
                                    {.num_threads = 1});
      return evaluator.evaluate(pose).area;
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool positive : {false, true}) {
        const Pose pose = test::axis_pose({16, 15, 17}, axis, positive);
        double sum = 0;
        for (int v = 0; v < kHeight; ++v) {
          for (int u = 0; u < kWidth; ++u) sum += area(1, 1, u, v, pose);
        }
        EXPECT_GT(sum, 0);
        EXPECT_NEAR(area(kWidth, kHeight, 0, 0, pose), sum, 1e-12 * sum)
            << "cells of 2^" << shift << ", axis " << axis;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, SurfaceOracle, testing::ValuesIn(test::kMapFamilies),
                         test::family_name);

}  // namespace
}  // namespace viewgain
