// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which voxel a noisy reading counts for.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "voxel_oracle.hpp"

namespace viewgain {
namespace {
using Carve = IntegrationConfig::Carve;

using namespace test;

constexpr double kVoxel = 0.0125;

BeliefGrid turned_grid() {
  GridConfig config{kVoxel, {{-0.19, -0.171, -0.2}, {0.17, 0.205, 0.113}}, {}, 0.01};
  config.T_world_grid =
      Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
           Eigen::Vector3d(0.03, -0.05, 0.02));
  return BeliefGrid(config);
}

/// A frame whose readings are off along their rays by the sensor's own sigma.
DepthFrame noisy(const Sensor& sensor, DepthFrame frame, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      float& depth = frame.depth[static_cast<std::size_t>(v * frame.width + u)];
      if (!(depth > 0) || depth == DepthFrame::kOutOfRange) continue;
      const double length = sensor.camera.ray(u, v).norm();
      const double range = depth * length;
      depth = static_cast<float>((range + sensor.sigmas(range).axial * normal(random)) / length);
    }
  }
  return frame;
}

TEST(Association, EqualsASearch) {
  std::mt19937 random(3);
  for (const double sigma : {0.3, 0.5, 0.9, 2.0, 5.0}) {  // voxels
    for (const Carve carve : {Carve::cones, Carve::lines}) {
      Sensor sensor = carve == Carve::cones ? small_sensor(48, 36) : small_sensor(12, 9);
      sensor.noise = ConstantNoise{sigma * kVoxel, 0.003};
      BeliefGrid grid = turned_grid();
      VoxelOracle oracle(grid);
      FrameIntegrator integrator(sensor, {carve, IntegrationConfig::Occupancy::probabilistic, {}},
                                 {2});
      std::uint64_t moved = 0;
      for (int view = 0; view < 4; ++view) {
        const Pose pose = ring_view(view);
        const DepthFrame frame =
            noisy(sensor, see_spheres(sensor, pose, three_spheres_in_a_room()), random);
        const IntegrationReport report = integrator.integrate(grid, frame, pose);
        oracle.integrate(sensor, frame, pose,
                         {carve, IntegrationConfig::Occupancy::probabilistic, {}});
        EXPECT_EQ(oracle.differences(grid), 0U) << sigma << " voxels, view " << view;
        EXPECT_EQ(report.voxels_hit, oracle.hit()) << sigma << " voxels, view " << view;
        moved += oracle.moved();
      }
      if (sigma < 0.5) {
        EXPECT_EQ(moved, 0U);
      } else if (carve == Carve::cones) {
        EXPECT_GT(moved, 0U) << sigma;
      }
    }
  }
}

/// One pixel that looks along +z from the origin.
Sensor one_pixel(double sigma) {
  Sensor sensor = small_sensor(1, 1);
  sensor.camera.fx = sensor.camera.fy = 220.0;
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.noise = ConstantNoise{sigma, 0.001};
  return sensor;
}

/// A column of voxels of 1 cm along z, from 0.4 to 0.6 m.
BeliefGrid column() {
  return BeliefGrid(GridConfig{0.01, {{-0.01, -0.01, 0.4}, {0.01, 0.01, 0.6}}, {}, 0.01});
}

std::uint32_t hits(const BeliefGrid& grid, int z) {
  const auto belief = grid.belief({0, 0, z});
  return belief ? belief->hits : 0;
}

void read(BeliefGrid& grid, double sigma, double depth, int times = 1) {
  FrameIntegrator integrator(one_pixel(sigma));
  for (int i = 0; i < times; ++i) {
    integrator.integrate(grid, {1, 1, {static_cast<float>(depth)}}, {});
  }
}

TEST(Association, GoesWhereMoreThanTwiceTheValueIs) {
  // Own voxel 48: the reading itself. Voxel 50, n readings, begins 1.4 voxels on: met after 1.5 of
  // 3 voxels, whence a weight of 3/4.
  for (const int n : {1, 2, 3, 4, 10}) {
    BeliefGrid grid = column();
    read(grid, 0.001, 0.505, n);
    read(grid, 0.01, 0.486);
    const bool moves = n * 0.75 > 2.0;
    EXPECT_EQ(hits(grid, 50), static_cast<std::uint32_t>(moves ? n + 1 : n)) << n;
    EXPECT_EQ(hits(grid, 48), moves ? 0U : 1U) << n;
  }
  // Where the map has readings of its own, n must be larger.
  BeliefGrid grid = column();
  read(grid, 0.001, 0.505, 8);
  read(grid, 0.001, 0.486);
  read(grid, 0.01, 0.486);
  EXPECT_EQ(hits(grid, 48), 1U);
  EXPECT_EQ(hits(grid, 50), 9U);
  read(grid, 0.001, 0.486, 4);
  read(grid, 0.01, 0.486);
  EXPECT_EQ(hits(grid, 48), 6U);
}

TEST(Association, SurfaceThatHasGoneAttractsNothing) {
  BeliefGrid grid = column();
  FrameIntegrator integrator(one_pixel(0.01),
                             {Carve::lines, IntegrationConfig::Occupancy::probabilistic, {}});
  const Pose beside(Eigen::Matrix3d::Identity(), {0.004, 0.004, 0});
  const auto see = [&](float depth, int times) {
    for (int i = 0; i < times; ++i) integrator.integrate(grid, {1, 1, {depth}}, beside);
  };
  see(0.475F, 30);
  EXPECT_EQ(grid.state({0, 0, 47}), VoxelState::occupied);
  see(0.595F, 60);
  ASSERT_EQ(grid.state({0, 0, 47}), VoxelState::free);
  see(0.495F, 30);
  EXPECT_EQ(grid.state({0, 0, 49}), VoxelState::occupied);
  EXPECT_EQ(grid.state({0, 0, 47}), VoxelState::free);
  EXPECT_EQ(hits(grid, 49), 30U);
  EXPECT_EQ(hits(grid, 47), 30U);
}

/// Occupied voxels along z where the wall is seen, in the mean of the columns.
double thickness(const BeliefGrid& grid) {
  double occupied = 0;
  std::set<std::array<int, 2>> columns;
  grid.for_each_occupied([&](const BeliefGrid::VoxelValue& at) {
    const Index3 v = at.voxel;
    if (std::abs(v.x) > 8 || std::abs(v.y) > 8) return;
    ++occupied;
    columns.insert({v.x, v.y});
  });
  EXPECT_EQ(columns.size(), 17U * 17U);
  return occupied / static_cast<double>(columns.size());
}

// A wall and, before it, a plate of 3 mm, both across the view, by a sensor as noisy as the voxels
// are large.
TEST(Association, WallsStayThinAndThinThingsStay) {
  Sensor sensor = small_sensor(64, 48);
  sensor.noise = ConstantNoise{0.01, 0.003};
  const GridConfig config{0.01, {{-0.2, -0.2, -0.3}, {0.2, 0.2, 0.3}}, {}, 0.01};
  const auto seen = [&](double z_wall, bool both_sides, int frames) {
    BeliefGrid grid(config);
    FrameIntegrator integrator(sensor);
    std::mt19937 random(9);
    for (int i = 0; i < frames; ++i) {
      const bool behind = both_sides && i % 2 == 1;
      const double eye = behind ? 0.5 : -0.5;
      const Pose pose = look_at({0.01 * std::cos(i), 0.01 * std::sin(i), eye}, {0, 0, 0});
      DepthFrame frame{64, 48, {}};
      const double plane = behind ? z_wall + 0.003 : z_wall;
      for (const Eigen::Vector3d& ray : sensor.camera.ray_table()) {
        const double dz = (pose.rotation() * ray).z();
        frame.depth.push_back(static_cast<float>((plane - pose.translation().z()) / dz));
      }
      integrator.integrate(grid, noisy(sensor, frame, random), pose);
    }
    return thickness(grid);
  };
  for (const double z : {0.0004, 0.0025, 0.005, 0.0075}) {  // in the voxel
    EXPECT_LE(seen(z, false, 40), 1.8) << z;
    const double plate = seen(z, true, 40);
    EXPECT_LE(plate, 2.6) << z;
    EXPECT_GE(plate, 1.0) << z;
  }
}

TEST(Association, TheOrderOfPointsDoesNotMatter) {
  Sensor sensor = small_sensor(48, 36);
  sensor.noise = ConstantNoise{0.9 * kVoxel, 0.003};
  std::mt19937 random(6);
  std::vector<std::array<double, 3>> points;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> across(-0.1, 0.1);
  for (int i = 0; i < 3000; ++i) {
    points.push_back({across(random), across(random), 0.9 * kVoxel * normal(random)});
  }
  const Pose pose = look_at({0.05, 0, -0.6}, {0, 0, 0});
  const auto counts = [&] {
    BeliefGrid grid = turned_grid();
    CloudIntegrator(sensor).integrate(grid, points, pose);
    std::string text;
    grid.for_each_belief([&](Index3 v, const Belief& b) {
      text += std::to_string(v.x) + ',' + std::to_string(v.y) + ',' + std::to_string(v.z) + ':' +
              std::to_string(b.hits) + ' ';
    });
    return text;
  };
  const std::string in_order = counts();
  std::shuffle(points.begin(), points.end(), random);
  EXPECT_EQ(counts(), in_order);
  EXPECT_GT(in_order.size(), 1000U);
}

}  // namespace
}  // namespace viewgain
