// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface and combined gain of random maps against the double-precision oracle, under each
// instruction set.
#include <gtest/gtest.h>

#include <algorithm>

#include "oracle/surface.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

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

Obstacles random_obstacles(const BeliefGrid& grid, int number, test::Random& random) {
  Obstacles obstacles;
  if (number % 3 != 2) return obstacles;
  const Box all = grid.workspace();
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector3d p;
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      p[a] = test::uniform(random, all.min[i], all.max[i]);
    }
    p = grid.T_world_grid() * p;
    const double half = 0.05 * (all.max[0] - all.min[0]);
    obstacles.boxes.push_back(
        {{p.x() - half, p.y() - half, p.z() - half}, {p.x() + half, p.y() + half, p.z() + half}});
  }
  return obstacles;
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
    const Obstacles obstacles = random_obstacles(made.grid, i, random);
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
