// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Point clouds into a map, against loops over all voxels.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <random>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "voxel_oracle.hpp"

namespace viewgain {
namespace {

using namespace test;

using Points = std::vector<std::array<double, 3>>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Sensor cloud_sensor() {
  Sensor sensor = small_sensor(40, 30);
  sensor.noise = ConstantNoise{0.004, 0.002};
  return sensor;
}

/// The frame's points in the world; NaN where there is no depth.
Points points_of(const Sensor& sensor, const DepthFrame& frame, const Pose& pose) {
  const auto rays = sensor.camera.ray_table();
  Points points;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto depth = static_cast<double>(frame.depth[i]);
    const Eigen::Vector3d p = pose * (rays[i] * depth);
    points.push_back(depth > 0 ? std::array{p.x(), p.y(), p.z()} : std::array{kNaN, kNaN, kNaN});
  }
  return points;
}

TEST(Cloud, MakesTheMapThatTheLiteralLoopsMake) {
  const GridConfig plain{0.0125, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01};
  GridConfig turned{0.0131, {{-0.19, -0.171, -0.2}, {0.17, 0.205, 0.113}}, {}, 0.01};
  turned.T_world_grid =
      Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
           Eigen::Vector3d(0.03, -0.05, 0.02));
  const Sensor sensor = cloud_sensor();
  std::mt19937 random(8);
  for (const GridConfig& config : {plain, turned}) {
    for (const IntegrationConfig::Occupancy occupancy :
         {IntegrationConfig::Occupancy::probabilistic, IntegrationConfig::Occupancy::literal}) {
      BeliefGrid grid(config);
      VoxelOracle oracle(grid);
      CloudIntegrator integrator(sensor, {.occupancy = occupancy}, {2});
      for (int view = 0; view < 4; ++view) {
        const Pose pose = ring_view(view);
        const DepthFrame frame = mixed_frame(sensor, pose, random, false);
        oracle.integrate(sensor, frame, pose, {IntegrationConfig::Carve::lines, occupancy, {}});
        const IntegrationReport report =
            integrator.integrate(grid, points_of(sensor, frame, pose), pose);
        EXPECT_EQ(report.voxels_crossed, oracle.crossed());
        EXPECT_EQ(report.voxels_hit, oracle.hit());
        EXPECT_GT(report.readings_inside, 100U);
        EXPECT_GT(report.out_of_range, 10U);
        EXPECT_GT(report.invalid, 10U);
      }
      EXPECT_EQ(oracle.differences(grid), 0U);
      EXPECT_EQ(grid.views().size(), 4U);
    }
  }
}

TEST(Cloud, ThreadsDoNotMatter) {
  const Sensor sensor = cloud_sensor();
  std::mt19937 random(1);
  std::vector<std::string> hashes;
  const DepthFrame frame = mixed_frame(sensor, ring_view(1), random, false);
  const Points points = points_of(sensor, frame, ring_view(1));
  for (const int threads : {1, 2, 3, 7}) {
    BeliefGrid grid(object_grid(64));
    CloudIntegrator integrator(sensor, {}, {threads});
    integrator.integrate(grid, points, ring_view(1));
    integrator.integrate(grid, points, ring_view(2));
    hashes.push_back(grid.content_hash());
  }
  EXPECT_EQ(hashes, std::vector<std::string>(4, hashes[0]));
}

TEST(Cloud, PointsAreSortedByRange) {
  Sensor sensor = cloud_sensor();
  sensor.min_range = 0.1;
  sensor.max_range = 1.0;
  BeliefGrid grid({0.05, {{0, 0, 0}, {2, 0.5, 0.5}}, {}, 0.01});
  const Pose origin(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.01, 0.02, 0.03));
  const Points points{{0.5, 0.02, 0.03},                          // a reading inside
                      {0.01, -0.5, 0.03},                         // outside
                      {1.5, 0.02, 0.03},                          // carves to max_range
                      {1e200, 1e200, 1e200}, {0.05, 0.02, 0.03},  // too near
                      {0.01, 0.02, 0.03},                         // the origin
                      {kNaN, 0, 0},          {0, kInfinity, 0},  {0, 0, -kInfinity}};
  const IntegrationReport report = CloudIntegrator(sensor).integrate(grid, points, origin);
  EXPECT_EQ(report.readings, 2U);
  EXPECT_EQ(report.readings_inside, 1U);
  EXPECT_EQ(report.out_of_range, 2U);
  EXPECT_EQ(report.invalid, 5U);
  EXPECT_EQ(report.voxels_hit, 1U);
  EXPECT_EQ(grid.state({10, 0, 0}), VoxelState::occupied);
  EXPECT_EQ(grid.state({9, 0, 0}), VoxelState::free);
  EXPECT_EQ(grid.state({0, 0, 0}), VoxelState::free);
  EXPECT_EQ(grid.state({20, 0, 0}), VoxelState::free);  // 1.01 m is reached
  EXPECT_EQ(grid.state({21, 0, 0}), VoxelState::unknown);
  const auto belief = grid.belief({10, 0, 0});
  ASSERT_TRUE(belief.has_value());
  EXPECT_NEAR(belief->information[0], 1 / (0.004 * 0.004), 0.1);
  EXPECT_NEAR(belief->information[1], 1 / (0.002 * 0.002), 0.4);
  EXPECT_EQ(grid.views(), std::vector<Pose>{origin});

  const std::string before = grid.content_hash();
  CloudIntegrator integrator(sensor);
  Pose bad = origin;
  bad.m[0] = 1.1;
  expect_error(ErrorCode::invalid_argument, "the camera pose is not a rigid transform",
               [&] { integrator.integrate(grid, points, bad); });
  EXPECT_EQ(grid.content_hash(), before);
  expect_error(ErrorCode::invalid_argument, "support plane",
               [&] { CloudIntegrator(sensor, {.support_plane = kNaN}); });
  sensor.max_range = 0;
  expect_error(ErrorCode::invalid_argument, "range", [&] { CloudIntegrator{sensor}; });

  const IntegrationReport none = integrator.integrate(grid, {}, origin);
  EXPECT_EQ(none.readings + none.invalid + none.out_of_range + none.voxels_crossed, 0U);
}

TEST(Cloud, ASupportPlaneIsCarvedToButNotHit) {
  const Sensor sensor = cloud_sensor();
  const Pose above(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 0.5));
  BeliefGrid grid(object_grid(64));
  const Points points{{0.01, 0, 0.1},     // on a thing
                      {0.1, 0, -0.099},   // 1 mm over the table: within 3 sigma
                      {0.15, 0, -0.101},  // under it
                      {-0.1, 0, -0.05}};  // 50 mm over it
  const IntegrationConfig config{.support_plane = -0.1};
  const IntegrationReport report = CloudIntegrator(sensor, config).integrate(grid, points, above);
  EXPECT_EQ(report.readings, 2U);
  EXPECT_EQ(report.plane_readings, 2U);
  EXPECT_EQ(grid.statistics().occupied, 2U);
  const auto bounds = reading_bounds(sensor, points, above, {}, -0.1);
  ASSERT_TRUE(bounds.has_value());
  EXPECT_EQ(*bounds, (Box{{-0.1, 0, -0.05}, {0.01, 0, 0.1}}));
  EXPECT_EQ(*reading_bounds(sensor, points, above), (Box{{-0.1, 0, -0.101}, {0.15, 0, 0.1}}));
  EXPECT_FALSE(reading_bounds(sensor, Points{{kNaN, 0, 0}}, above).has_value());
}

}  // namespace
}  // namespace viewgain
