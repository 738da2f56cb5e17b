// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Incidence from the amplitude of a frame.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

const GridConfig kBox{0.1, {{-1, -1, 0}, {1, 1, 1.5}}, {}, 0.01};

TEST(Amplitude, GivesTheCosineOfIncidence) {
  Sensor sensor = small_sensor(1, 1);
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.noise = ShotNoise{};
  const double t = 0.55;
  struct Case {
    double amplitude, cosine;
  };
  for (const auto& [amplitude, cosine] :
       {Case{1 / (t * t), 1.0}, Case{0.5 / (t * t), 0.5}, Case{0.2 / (t * t), 0.2},
        Case{0.01 / (t * t), kMinCosIncidence}, Case{7.0 / (t * t), 1.0},
        Case{0.0, kMinCosIncidence}, Case{-1.0, kMinCosIncidence},
        Case{std::nan(""), kMinCosIncidence}, Case{std::numeric_limits<double>::infinity(), 1.0}}) {
    BeliefGrid grid(kBox);
    const DepthFrame frame{1, 1, {static_cast<float>(t)}, {static_cast<float>(amplitude)}};
    EXPECT_EQ(FrameIntegrator(sensor).integrate(grid, frame, Pose{}).voxels_hit, 1U);
    const auto belief = grid.belief({0, 0, 5});
    ASSERT_TRUE(belief.has_value());
    const double sigma = sensor.sigmas(t, cosine).axial;
    EXPECT_NEAR(belief->information[2], 1 / (sigma * sigma), 1e-5 / (sigma * sigma)) << amplitude;
  }
}

TEST(Amplitude, ReplacesTheNeighbourhoodAndOnlyWhereThereIsOne) {
  Sensor sensor = small_sensor(48, 36);
  sensor.noise = ShotNoise{};
  // A frontal plane whose amplitudes say 60°.
  DepthFrame frame{48, 36, std::vector<float>(48 * 36, 0.55F)};
  const auto information = [&] {
    BeliefGrid grid(kBox);
    FrameIntegrator(sensor).integrate(grid, frame, Pose{});
    const auto belief = grid.belief({0, 0, 5});
    EXPECT_TRUE(belief.has_value());
    return belief ? static_cast<double>(belief->information[2]) / belief->hits : 0.0;
  };
  const double by_neighbourhood = information();
  const auto rays = sensor.camera.ray_table();
  const auto set_cosine = [&](double cosine) {
    frame.amplitude.clear();
    for (const Eigen::Vector3d& ray : rays) {
      frame.amplitude.push_back(static_cast<float>(cosine / (0.55 * ray).squaredNorm()));
    }
  };
  set_cosine(0.5);
  EXPECT_NEAR(information(), 0.5 * by_neighbourhood, 0.03 * by_neighbourhood);
  set_cosine(1.0);
  EXPECT_NEAR(information(), by_neighbourhood, 0.03 * by_neighbourhood);
}

TEST(Amplitude, OfAnotherSizeIsRefused) {
  const Sensor sensor = small_sensor(4, 3);
  BeliefGrid grid(kBox);
  FrameIntegrator integrator(sensor);
  for (const std::size_t size : {1U, 11U, 13U}) {
    const DepthFrame frame{4, 3, std::vector<float>(12, 0.5F), std::vector<float>(size, 1.0F)};
    expect_error(ErrorCode::invalid_argument, std::to_string(size) + " amplitudes",
                 [&] { integrator.integrate(grid, frame, Pose{}); });
    EXPECT_THROW((void)reading_bounds(sensor, frame, Pose{}), Error);
  }
  EXPECT_TRUE(grid.views().empty());
}

}  // namespace
}  // namespace viewgain
