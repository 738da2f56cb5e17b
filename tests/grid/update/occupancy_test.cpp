// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// How log-odds behave over many frames.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "core/scoped_variable.hpp"
#include "core/temporary_folder.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain {
namespace {

using namespace test;

// Frontal wall, SR4000 noise, voxels finer than the noise; all of the workspace is in view.
TEST(Occupancy, AWallSeenFiftyTimesWithNoiseStays) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 60;
  sensor.camera.height = 60;
  sensor.camera.cx = sensor.camera.cy = 29.5;
  const double z = 0.45;
  BeliefGrid grid({0.003125, {{-0.05, -0.05, 0.4}, {0.05, 0.05, 0.5}}, {}, 0.0072});
  FrameIntegrator integrator(sensor);
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, sensor.sigmas(z).axial);
  int columns = 0;
  for (int frame = 1; frame <= 50; ++frame) {
    DepthFrame noisy = see_plane(sensor, z);
    for (float& depth : noisy.depth) depth += static_cast<float>(normal(random));
    integrator.integrate(grid, noisy, Pose{});
    if (frame != 3 && frame != 10 && frame != 50) continue;
    // No line along the optical axis may see through, nor stop far from the wall.
    for (int i = -16; i < 16; ++i) {
      for (int j = -16; j < 16; ++j) {
        int k = grid.min_index().z;
        while (k < grid.min_index().z + grid.dims().z && grid.state({i, j, k}) == VoxelState::free)
          ++k;
        EXPECT_NEAR((k + 0.5) * grid.voxel_size(), z, 4 * sensor.sigmas(z).axial)
            << i << " " << j << " after " << frame;
        if (frame == 50) {
          bool occupied = false;
          for (int n = -3; n <= 3; ++n) {
            occupied = occupied || grid.state({i, j, 144 + n}) == VoxelState::occupied;
          }
          EXPECT_TRUE(occupied) << i << " " << j;
          ++columns;
        }
      }
    }
  }
  EXPECT_EQ(columns, 1024);
  EXPECT_EQ(grid.views().size(), 50U);
}

TEST(Occupancy, LogOddsAreClampedAndRoundedToSteps) {
  const Sensor sensor = small_sensor(24, 18);
  BeliefGrid grid({0.02, {{-0.1, -0.1, 0.2}, {0.1, 0.1, 0.6}}, {}, 0.01});
  FrameIntegrator integrator(sensor);
  const Index3 before{0, 0, 15}, at{0, 0, 25};  // centres at 0.31 and 0.51
  for (int i = 1; i <= 8; ++i) {
    integrator.integrate(grid, see_plane(sensor, 0.51), Pose{});
    EXPECT_FLOAT_EQ(grid.log_odds(before).value(), std::max(-0.4F * static_cast<float>(i), -2.0F));
    EXPECT_FLOAT_EQ(grid.log_odds(at).value(), std::min(0.85F * static_cast<float>(i), 3.5F));
  }
  EXPECT_FALSE(grid.log_odds({0, 0, 27}).has_value());
}

// No thin unknown shell may stay in front of a surface: weight 0 makes a voxel known, and free.
TEST(Occupancy, CrossedWithoutWeightIsFree) {
  Sensor sensor = small_sensor(24, 18);
  sensor.noise = ConstantNoise{0.05, 0.05};  // 3 sigma are 150 mm
  BeliefGrid grid({0.005, {{-0.1, -0.1, 0.2}, {0.1, 0.1, 0.6}}, {}, 0.01});
  FrameIntegrator(sensor).integrate(grid, see_plane(sensor, 0.501), Pose{});
  std::vector<float> column;
  for (int k = 60; k < 100; ++k) {
    ASSERT_EQ(grid.state({0, 0, k}), VoxelState::free) << k;
    column.push_back(grid.log_odds({0, 0, k}).value());
  }
  EXPECT_EQ(column.back(), 0.0F);  // 3.5 mm before the reading, 8 * 3.5 / 150 rounds to 0
  EXPECT_FLOAT_EQ(column.front(), -0.4F);
  EXPECT_TRUE(std::is_sorted(column.begin(), column.end()));
  // Rounded to nearest at each distance.
  for (int k = 60; k < 100; ++k) {
    const double range = Eigen::Vector3d(0.0025, 0.0025, (k + 0.5) * 0.005).norm();
    const Eigen::Vector2d at = sensor.camera.project({0.0025, 0.0025, (k + 0.5) * 0.005});
    const double reading =
        0.501F * sensor.camera.ray(std::floor(at.x() + 0.5), std::floor(at.y() + 0.5)).norm();
    const double weight = std::min(8.0, 8.0 * (reading - range) / 0.15);
    EXPECT_FLOAT_EQ(column[static_cast<std::size_t>(k - 60)],
                    static_cast<float>(-0.05 * std::floor(weight + 0.5)))
        << k;
  }
  EXPECT_EQ(column.size(), 40U);
}

// The map is the same bit for bit whatever runs it.

using Occupancy = IntegrationConfig::Occupancy;
using Carve = IntegrationConfig::Carve;

Sensor noisy_sensor(bool distorted) {
  Sensor sensor = small_sensor(64, 48);  // for more than one thread
  if (distorted) sensor.camera.distortion = {-0.2, 0.05, 0.001, -0.002, 0.01};
  return sensor;
}

DepthFrame noisy_frame(const Sensor& sensor, int view) {
  DepthFrame frame = see_spheres(sensor, ring_view(view), three_spheres_in_a_room());
  std::mt19937 random(static_cast<unsigned>(view));
  std::normal_distribution<float> normal(0.0F, 0.004F);
  std::uniform_int_distribution<int> dice(0, 49);
  for (float& depth : frame.depth) {
    depth += normal(random);
    const int roll = dice(random);
    if (roll == 0) depth = DepthFrame::kInvalid;
    if (roll == 1) depth = DepthFrame::kOutOfRange;
  }
  return frame;
}

BeliefGrid turned_grid() {
  GridConfig config = object_grid(36);
  config.T_world_grid =
      Pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix(),
           Eigen::Vector3d(0.01, 0.02, 0.03));
  return BeliefGrid(config);
}

std::string hash_of_run(const Sensor& sensor, const IntegrationConfig& config, int threads) {
  BeliefGrid grid = turned_grid();
  FrameIntegrator integrator(sensor, config, {threads});
  for (int view = 0; view < 3; ++view) {
    integrator.integrate(grid, noisy_frame(sensor, view), ring_view(view));
  }
  return grid.content_hash();
}

TEST(Determinism, ThreadsAndInstructionSets) {
  struct Rule {
    bool distorted;
    IntegrationConfig config;
    std::optional<double> sigma{};  // [m]; from half a voxel on, readings move to their surface
    int width = 64;                 // 61 is no multiple of a vector's lanes, 5 less than some
  };
  int rules = 0;
  for (const auto& [distorted, config, sigma, width] :
       {Rule{false, {Carve::cones, Occupancy::probabilistic}},
        Rule{true, {Carve::cones, Occupancy::probabilistic}},
        Rule{true, {Carve::cones, Occupancy::literal}},
        Rule{false, {Carve::lines, Occupancy::probabilistic}},
        Rule{true, {Carve::lines, Occupancy::literal}}, Rule{false, {}, 0.009},
        Rule{true, {}, 0.02}, Rule{false, {}, 0.02, 61}, Rule{false, {}, 0.02, 5}}) {
    Sensor sensor = noisy_sensor(distorted);
    if (sigma) sensor.noise = ConstantNoise{*sigma, 0.002};
    sensor.camera.width = width;
    sensor.camera.cx = 0.5 * (width - 1);
    const std::string expected = hash_of_run(sensor, config, 1);
    for (const int threads : {1, 2, 3, 8}) {
      EXPECT_EQ(hash_of_run(sensor, config, threads), expected) << threads;
    }
    for (const Isa isa : supported_isas()) {
      const ScopedIsa limit(std::string(isa_name(isa)));
      EXPECT_EQ(hash_of_run(sensor, config, 2), expected) << isa_name(isa);
    }
    ++rules;
  }
  EXPECT_EQ(rules, 9);
}

TEST(Determinism, AnIntegratorHasNoMemoryOfOtherFrames) {
  const Sensor sensor = noisy_sensor(true);
  for (const Carve carve : {Carve::cones, Carve::lines}) {
    FrameIntegrator used(sensor, {carve, Occupancy::probabilistic}, {2});
    BeliefGrid other(object_grid(31));
    for (int view = 0; view < 3; ++view) {
      used.integrate(other, noisy_frame(sensor, view), ring_view(view));
    }
    BeliefGrid a = turned_grid(), b = turned_grid();
    used.integrate(a, noisy_frame(sensor, 5), ring_view(5));
    FrameIntegrator(sensor, {carve, Occupancy::probabilistic}, {2})
        .integrate(b, noisy_frame(sensor, 5), ring_view(5));
    EXPECT_EQ(a.content_hash(), b.content_hash());
  }
}

TEST(Determinism, SavingAndLoadingBetweenFramesChangesNothing) {
  const TemporaryFolder folder;
  const Sensor sensor = noisy_sensor(false);
  BeliefGrid straight = turned_grid(), through_files = turned_grid();
  FrameIntegrator integrator(sensor, {}, {2});
  for (int view = 0; view < 4; ++view) {
    const DepthFrame frame = noisy_frame(sensor, view);
    integrator.integrate(straight, frame, ring_view(view));
    integrator.integrate(through_files, frame, ring_view(view));
    save_vdb(through_files, folder.path() / "map.vdb");
    through_files = load_vdb(folder.path() / "map.vdb");
    EXPECT_EQ(through_files.content_hash(), straight.content_hash()) << view;
  }
}

}  // namespace
}  // namespace viewgain
