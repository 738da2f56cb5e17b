// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Readings of what is known to be there carve but do not hit, and teach nothing of the unknown.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

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
  const HazardField hazard(grid.snapshot());
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
