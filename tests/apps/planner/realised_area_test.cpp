// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What a frame shows of new surface: planes whose area is known, and a frame of random readings
// against a count by hand.
#include "scorer/realised_area.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "apps/planner/planner_scene.hpp"
#include "core/expect_error.hpp"

namespace viewgain {
namespace {

using detail::RealisedArea;

constexpr double kVoxel = 0.005;
constexpr double kEye = 0.4;  // above the plane z = 0 [m]

BeliefGrid empty_map(double half = 0.3) {
  return BeliefGrid(test::model_config(test::half_sr4000(), half, kVoxel).map.grid());
}

// Looks straight down at the plane z = 0.
Pose from_above() { return look_at({0, 0, kEye}, {0, 0, 0}); }

// How much less than from the working distance readings say: they miss the surface by σ_ax.
double worth(const Sensor& sensor, double range) {
  const auto misses = [&](double t) { return 1 + sensor.noise_sigmas(t).axial / kVoxel; };
  return misses(sensor.working_distance) / misses(range);
}

// All pixels read a plane across the optical axis.
DepthFrame plane_frame(const Sensor& sensor, double depth) {
  const auto pixels = static_cast<std::size_t>(sensor.camera.width * sensor.camera.height);
  return {sensor.camera.width,
          sensor.camera.height,
          std::vector<float>(pixels, static_cast<float>(depth)),
          {}};
}

TEST(RealisedArea, APlaneSeenFrontallyFillsItsArea) {
  Sensor sensor = test::half_sr4000();
  // Under 3°, so that area across the ray is area of the plane.
  sensor.camera.fx *= 8, sensor.camera.fy *= 8;
  const PinholeCamera& c = sensor.camera;
  const double area = c.width * kEye / c.fx * (c.height * kEye / c.fy);
  const RealisedArea realised(sensor, kVoxel);
  EXPECT_NEAR(realised.of(plane_frame(sensor, kEye), from_above(), empty_map(), nullptr), area,
              2e-3 * area);
  // Seen from the side, by the wide camera, what counts is what lies across the rays.
  const Sensor wide = test::half_sr4000();
  double across = 0;
  for (const Eigen::Vector3d& ray : wide.camera.ray_table()) {
    across += kEye * kEye / (wide.camera.fx * wide.camera.fy) / ray.norm() *
              worth(wide, kEye * ray.norm());
  }
  EXPECT_NEAR(
      RealisedArea(wide, kVoxel).of(plane_frame(wide, kEye), from_above(), empty_map(), nullptr),
      across, 1e-8);
}

TEST(RealisedArea, NothingIsShownByWhatIsNoReading) {
  const Sensor sensor = test::half_sr4000();
  const RealisedArea realised(sensor, kVoxel);
  const BeliefGrid grid = empty_map();
  for (const float depth :
       {DepthFrame::kInvalid, DepthFrame::kOutOfRange, std::numeric_limits<float>::quiet_NaN(),
        -0.4F, 0.1F, 5.5F, 0.9F}) {  // nearer and farther than it measures, beside the workspace
    EXPECT_EQ(realised.of(plane_frame(sensor, depth), from_above(), grid, nullptr), 0) << depth;
  }
  test::expect_error(ErrorCode::invalid_argument, "6 values", [&] {
    (void)realised.of({3, 2, std::vector<float>(6, 0.4F), {}}, from_above(), grid, nullptr);
  });
}

TEST(RealisedArea, WhatIsKnownShowsNothing) {
  const Sensor sensor = test::half_sr4000();
  const RealisedArea realised(sensor, kVoxel);
  const BeliefGrid grid = empty_map();
  DepthFrame frame = plane_frame(sensor, kEye);
  const double all = realised.of(frame, from_above(), grid, nullptr);
  // The left half of the image is known: at the reading, behind it and clearly before.
  const std::size_t pixels = frame.depth.size();
  for (const auto& [before, share] : {std::pair(0.0F, 0.5), {-0.1F, 0.5}, {0.2F, 1.0}}) {
    frame.known_depth.assign(pixels, DepthFrame::kOutOfRange);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (i % static_cast<std::size_t>(frame.width) < static_cast<std::size_t>(frame.width) / 2) {
        frame.known_depth[i] = frame.depth[i] + before;
      }
    }
    EXPECT_NEAR(realised.of(frame, from_above(), grid, nullptr), share * all, 0.01 * all) << before;
  }
}

Belief hit(std::uint32_t hits) { return {{1e6F, 1e6F, 1e6F, 0.F, 0.F, 0.F}, {}, hits}; }

// Hazard cells of one voxel.
HazardField fine_hazard(const BeliefGrid& grid) {
  HazardConfig config;
  config.model = HazardConfig::Model{20, 4 * kVoxel, 0.5};
  return HazardField(grid.snapshot(), config);
}

TEST(RealisedArea, TheSupportPlaneIsNotSurface) {
  const Sensor sensor = test::half_sr4000();
  const BeliefGrid grid = empty_map();
  const double sigma = sensor.sigmas(kEye).axial;
  for (const double above : {-0.01, 0.0, 2.5 * sigma, 4.5 * sigma}) {
    const DepthFrame frame = plane_frame(sensor, kEye - above);
    const double with = RealisedArea(sensor, kVoxel, 0.0).of(frame, from_above(), grid, nullptr);
    const double without = RealisedArea(sensor, kVoxel).of(frame, from_above(), grid, nullptr);
    EXPECT_GT(without, 0);
    EXPECT_EQ(with, above > 3 * sigma ? without : 0.0) << above;
  }
}

TEST(RealisedArea, IsWhatAnOracleCounts) {
  std::mt19937_64 random(5);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  Sensor sensor = test::half_sr4000();
  sensor.camera.distortion = {-0.1, 0.02, 0.001, -0.001, 0};
  const RealisedArea realised(sensor, kVoxel);
  const std::vector<Eigen::Vector3d> rays = sensor.camera.ray_table();
  const std::vector<double> angles = sensor.camera.solid_angles(rays);
  std::size_t new_readings = 0, known = 0, near = 0;
  int maps = 0;
  for (; maps < 20; ++maps) {
    BeliefGrid grid = empty_map(0.1);
    std::vector<Index3> evidence;
    for (int i = 0; i < 4000; ++i) {
      const auto coordinate = [&] { return static_cast<int>(std::floor(uniform(-20, 20))); };
      const Index3 voxel{coordinate(), coordinate(), coordinate()};
      if (grid.state(voxel) != VoxelState::unknown) continue;
      const bool occupied = uniform(0, 1) < 0.05;
      const auto hits = static_cast<std::uint32_t>(1 + i % 5);
      occupied ? grid.set(voxel, 0.85F, hit(hits)) : grid.set(voxel, -0.4F);
      if (occupied && hits >= 3) evidence.push_back(voxel);
    }
    const HazardField hazard = fine_hazard(grid);
    const Pose pose = look_at({uniform(-0.2, 0.2), uniform(-0.2, 0.2), 0.4}, {0, 0, 0});
    DepthFrame frame = plane_frame(sensor, 0);
    for (float& z : frame.depth) z = static_cast<float>(uniform(0.25, 0.6));
    double expected = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d p = rays[i] * static_cast<double>(frame.depth[i]);
      if (p.norm() < sensor.min_range || p.norm() > sensor.max_range) continue;
      const auto voxel = grid.index_of(pose * p);
      if (!voxel) continue;
      if (grid.state(*voxel) != VoxelState::unknown) {
        ++known;
        continue;
      }
      bool is_near = false;
      for (const Index3& e : evidence) {
        const int dx = e.x - voxel->x, dy = e.y - voxel->y, dz = e.z - voxel->z;
        is_near = is_near || dx * dx + dy * dy + dz * dz <= 1;
      }
      if (is_near) {
        ++near;
        continue;
      }
      ++new_readings;
      expected += angles[i] * p.squaredNorm() * worth(sensor, p.norm());
    }
    EXPECT_NEAR(realised.of(frame, pose, grid, &hazard), expected, 1e-9 * expected);
  }
  EXPECT_EQ(maps, 20);
  EXPECT_GT(new_readings, 5000U);
  EXPECT_GT(known, 100U);
  EXPECT_GT(near, 100U);
}

}  // namespace
}  // namespace viewgain
