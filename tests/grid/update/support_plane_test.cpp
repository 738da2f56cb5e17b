// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Readings of the table that the object stands on carve but do not hit.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

constexpr double kSigma = 0.002;  // axial [m]

Sensor one_pixel() {
  Sensor sensor = small_sensor(1, 1);
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.min_range = 0.05;
  sensor.noise = ConstantNoise{kSigma, 2 * kSigma};
  return sensor;
}

/// What one pixel's reading at range t does to an empty map.
IntegrationReport read_once(const Pose& pose, double t, double plane) {
  BeliefGrid grid({0.01, {{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}}, {}, 0.01});
  const DepthFrame frame{1, 1, {static_cast<float>(t)}};
  return FrameIntegrator(one_pixel(), {.support_plane = plane}).integrate(grid, frame, pose);
}

TEST(SupportPlane, BoundsAreThreeSigmaAlongTheNormalAndBelow) {
  for (const double degrees : {0.0, 40.0, 70.0}) {  // of the ray from the vertical
    const double angle = degrees * std::numbers::pi / 180;
    const double to_plane = 0.3;
    // Three sigmas along the normal, as far along the ray.
    const double bound = 3 * std::hypot(kSigma, 2 * kSigma * std::tan(angle));
    const Eigen::Vector3d target(0.013, -0.021, 0.05);
    const Pose above =
        look_at(target + to_plane * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)), target);
    const Pose below =
        look_at(target - to_plane * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)), target);
    struct Reading {
      double before;  // the plane, along the ray [m]
      bool plane_from_above, plane_from_below;
    };
    for (const auto& [before, from_above, from_below] :
         {Reading{0.1, false, true}, Reading{1.05 * bound, false, true},
          Reading{0.95 * bound, true, true}, Reading{0.0005, true, true},
          Reading{-0.0005, true, false}, Reading{-0.02, true, false}}) {
      for (const auto& [pose, expected] : {std::pair{above, from_above}, {below, from_below}}) {
        const IntegrationReport report = read_once(pose, to_plane - before, 0.05);
        EXPECT_EQ(report.plane_readings, expected ? 1U : 0U) << degrees << " " << before;
        EXPECT_EQ(report.readings, expected ? 0U : 1U);
        EXPECT_EQ(report.voxels_hit, expected ? 0U : 1U);
        EXPECT_EQ(report.readings_inside, expected ? 0U : 1U);
        EXPECT_GT(report.voxels_crossed, 5U);
      }
    }
  }
  // A level ray never meets the plane; 1 mm above it is no reading of it.
  const Pose level = look_at({0.3, 0, 0.051}, {0, 0, 0.051});
  EXPECT_EQ(read_once(level, 0.25, 0.05).plane_readings, 0U);
  EXPECT_EQ(read_once(level, 0.25, 0.052).plane_readings, 1U);
}

TEST(SupportPlane, CarvesAsFarAsTheReadingReaches) {
  const Pose down = look_at({0.005, 0.005, 0.5}, {0.005, 0.005, 0});
  for (const IntegrationConfig::Carve carve :
       {IntegrationConfig::Carve::cones, IntegrationConfig::Carve::lines}) {
    for (const IntegrationConfig::Occupancy occupancy :
         {IntegrationConfig::Occupancy::probabilistic, IntegrationConfig::Occupancy::literal}) {
      const auto column = [&](std::optional<double> plane) {
        BeliefGrid grid({0.01, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.01});
        const DepthFrame frame{1, 1, {0.524F}};  // a point at z = -0.024
        const IntegrationConfig config{carve, occupancy, plane};
        FrameIntegrator(one_pixel(), config).integrate(grid, frame, down);
        std::string states;
        for (int k = 9; k >= -10; --k) {
          states += ".fo"[static_cast<int>(grid.state({0, 0, k}))];
        }
        return states;
      };
      EXPECT_EQ(column(std::nullopt), "ffffffffffffo.......");
      const std::string carved = column(0.0);
      EXPECT_EQ(carved.substr(0, 12), "ffffffffffff");
      EXPECT_EQ(carved.substr(13), ".......");
      EXPECT_NE(carved[12], 'o');
    }
  }
}

// A ball that half stands out of the table, seen from four sides, in a turned grid.
class SupportPlaneScene : public testing::Test {
 protected:
  static constexpr double kHeight = 0.0137;  // of the table [m]

  SupportPlaneScene() {
    sensor_ = small_sensor(64, 48);
    sensor_.noise = ConstantNoise{kSigma, kSigma};
    grid_config_ = {0.01, {{-0.15, -0.15, -0.15}, {0.15, 0.15, 0.15}}, {}, 0.01};
    grid_config_.T_world_grid =
        Pose(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix(),
             Eigen::Vector3d(0.01, 0.02, -0.01));
  }

  [[nodiscard]] DepthFrame see(const Pose& pose) const {
    DepthFrame frame = see_spheres(sensor_, pose, {{{0, 0, 0}, 0.09}, {{0, 0, 0}, 1.5}});
    const auto rays = sensor_.camera.ray_table();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d d = pose.rotation() * rays[i];
      const double depth = (kHeight - pose.translation().z()) / d.z();
      if (depth > 0) frame.depth[i] = std::min(frame.depth[i], static_cast<float>(depth));
    }
    return frame;
  }

  Sensor sensor_;
  GridConfig grid_config_;
};

TEST_F(SupportPlaneScene, OnlyVoxelsWithReadingsOfThePlaneDiffer) {
  BeliefGrid with(grid_config_), without(grid_config_);
  FrameIntegrator taking(sensor_), leaving(sensor_, {.support_plane = kHeight});
  std::set<std::tuple<int, int, int>> plane_voxels;
  std::uint64_t plane_readings = 0, expected_readings = 0;
  for (int view = 0; view < 4; ++view) {
    const Pose pose = ring_view(view);
    const DepthFrame frame = see(pose);
    taking.integrate(with, frame, pose);
    const IntegrationReport report = leaving.integrate(without, frame, pose);
    plane_readings += report.plane_readings;
    EXPECT_EQ(report.readings + report.plane_readings + report.out_of_range + report.invalid,
              frame.depth.size());
    const auto rays = sensor_.camera.ray_table();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d p_world = pose * (static_cast<double>(frame.depth[i]) * rays[i]);
      const Eigen::Vector3d d = pose.rotation() * rays[i].normalized();
      // The noise is as large in each direction.
      if (!(p_world.z() < kHeight || (d.z() < 0 && p_world.z() - kHeight < 3 * kSigma))) continue;
      ++expected_readings;
      const Eigen::Vector3d p = grid_config_.T_world_grid.inverse() * p_world / 0.01;
      plane_voxels.emplace(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                           static_cast<int>(std::floor(p.z())));
    }
  }
  EXPECT_EQ(plane_readings, expected_readings);
  EXPECT_GT(plane_readings, 3000U);

  std::size_t compared = 0, different = 0, occupied = 0;
  for_each_voxel(VoxelBox{{-15, -15, -15}, {15, 15, 15}}, [&](Index3 voxel) {
    ++compared;
    occupied += without.state(voxel) == VoxelState::occupied ? 1 : 0;
    if (with.state(voxel) == without.state(voxel) && with.belief(voxel) == without.belief(voxel)) {
      return;
    }
    EXPECT_TRUE(plane_voxels.contains({voxel.x, voxel.y, voxel.z})) << voxel.x << " " << voxel.y;
    ++different;
  });
  EXPECT_EQ(compared, 27'000U);
  EXPECT_GT(different, 300U);
  EXPECT_GT(occupied, 100U);
}

TEST_F(SupportPlaneScene, TheSameForAnyNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 2, 5}) {
    BeliefGrid grid(grid_config_);
    FrameIntegrator integrator(sensor_, {.support_plane = kHeight}, {threads});
    for (int view = 0; view < 2; ++view) {
      integrator.integrate(grid, see(ring_view(view)), ring_view(view));
    }
    if (first.empty()) first = grid.content_hash();
    EXPECT_EQ(grid.content_hash(), first);
  }
}

TEST_F(SupportPlaneScene, BoundsLeaveItOut) {
  const Pose pose = ring_view(1);
  const DepthFrame frame = see(pose);
  const auto all = reading_bounds(sensor_, frame, pose);
  const auto object = reading_bounds(sensor_, frame, pose, {}, kHeight);
  ASSERT_TRUE(all && object);
  EXPECT_LT(all->min[2], kHeight + 1e-6);
  EXPECT_GE(object->min[2], kHeight);
  // Everything on the table: nothing is left.
  EXPECT_FALSE(reading_bounds(sensor_, frame, pose, {}, 10.0).has_value());
}

TEST(SupportPlane, MustBeFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(FrameIntegrator(one_pixel(), {.support_plane = bad}), Error);
    EXPECT_THROW((void)reading_bounds(one_pixel(), {1, 1, {0.5F}}, Pose{}, {}, bad), Error);
  }
}

// Readings of what is known to be there carve but do not hit, and teach nothing of the unknown.

TEST(KnownDepth, CountsFromThereOn) {
  Sensor sensor = small_sensor(1, 1);
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.min_range = 0.05;
  sensor.noise = ConstantNoise{0.002, 0.002};
  const Pose down = look_at({0.005, 0.005, 0.5}, {0.005, 0.005, 0});
  for (const IntegrationConfig::Carve carve :
       {IntegrationConfig::Carve::cones, IntegrationConfig::Carve::lines}) {
    for (const auto& [before, is_known] : {std::pair(0.1F, false),
                                           {1e-6F, false},
                                           {0.0F, true},
                                           {-1e-6F, true},
                                           {-0.05F, true},
                                           {std::numeric_limits<float>::infinity(), false}}) {
      BeliefGrid grid({0.01, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.01});
      DepthFrame frame{1, 1, {0.5F}};
      frame.known_depth = {0.5F + before};
      const IntegrationReport report =
          FrameIntegrator(sensor, {.carve = carve}).integrate(grid, frame, down);
      EXPECT_EQ(report.plane_readings, is_known ? 1U : 0U) << before;
      EXPECT_EQ(report.readings, is_known ? 0U : 1U);
      EXPECT_EQ(report.voxels_hit, is_known ? 0U : 1U);
      EXPECT_GT(report.voxels_crossed, 5U);
      EXPECT_EQ(reading_bounds(sensor, frame, down).has_value(), !is_known);
    }
  }
}

TEST(KnownDepth, ItsSizeIsLookedAt) {
  const Sensor sensor = small_sensor(4, 3);
  BeliefGrid grid({0.01, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.01});
  DepthFrame frame{4, 3, std::vector<float>(12, 0.5F)};
  frame.known_depth.resize(11);
  FrameIntegrator integrator(sensor);
  expect_error(ErrorCode::invalid_argument, "11 known depths for 12 pixels",
               [&] { integrator.integrate(grid, frame, {}); });
  EXPECT_TRUE(grid.views().empty());
}

TEST(KnownDepth, MeetsNothingInCalibration) {
  const Sensor sensor = small_sensor(64, 48);
  BeliefGrid grid({0.01, {{-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}}, {}, 0.01});
  const Pose first = look_at({0.5, 0, 0.1}, {0, 0, 0}),
             second = look_at({0.1, 0.5, 0.1}, {0, 0, 0});
  const auto see = [&](const Pose& pose) { return see_spheres(sensor, pose, {{{0, 0, 0}, 0.12}}); };
  FrameIntegrator(sensor).integrate(grid, see(first), first);
  const HazardProbe hazard(grid.snapshot());
  const auto met = [&](const DepthFrame& frame) {
    BeliefGrid counted = grid.clone();
    HazardCalibration(sensor).count(counted, hazard, frame, second);
    std::int64_t sum = 0;
    for (const HazardCounters::Class& c : counted.hazard_counters().classes) sum += c.met;
    return sum;
  };
  DepthFrame frame = see(second);
  EXPECT_GT(met(frame), 0);
  frame.known_depth = frame.depth;  // all of it was known
  EXPECT_EQ(met(frame), 0);
  frame.known_depth.assign(frame.depth.size(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(met(frame), met(see(second)));
}

}  // namespace
}  // namespace viewgain
