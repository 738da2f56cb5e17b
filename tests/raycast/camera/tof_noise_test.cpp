// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Lateral and axial noise, the table, and what the camera tells of the truth.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "raycast/scene_makers.hpp"
#include "support/meshes.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A plane through (0, 0, z) whose normal makes the angle with the optical axis.
std::shared_ptr<const SurfaceScene> tilted_plane(double z, double angle) {
  TriangleMesh mesh = test::square_mesh(20, 0);
  for (auto& vertex : mesh.vertices) {
    const double x = vertex[0];
    vertex[0] = x * std::cos(angle);
    vertex[2] = z + x * std::sin(angle);
  }
  return std::make_shared<const SurfaceScene>(std::move(mesh));
}

Sensor one_pixel(const NoiseModel& noise) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera = {
      .width = 1, .height = 1, .fx = 1e5, .fy = 1e5, .cx = 0, .cy = 0, .distortion = {}};
  sensor.noise = noise;
  return sensor;
}

/// Mean and standard deviation of the readings of one pixel over many frames [m].
std::pair<double, double> moments(const SimulatedSensor& camera, int frames) {
  double sum = 0, squares = 0;
  for (int i = 0; i < frames; ++i) {
    const double z = camera.acquire(Pose{}, static_cast<std::uint64_t>(i)).depth[0];
    sum += z;
    squares += z * z;
  }
  const double mean = sum / frames;
  return {mean, std::sqrt(squares / frames - mean * mean)};
}

TEST(TofNoise, LateralNoiseReadsBesideTheRay) {
  constexpr int kFrames = 4000;
  const Sensor sensor = one_pixel(ConstantNoise{.sigma_axial = 1e-3, .sigma_lateral = 2e-3});
  for (const double angle : {0.0, 30.0, 60.0}) {
    const SimulatedSensor camera(tilted_plane(1.0, angle * kDegree), sensor,
                                 {.seed = 3, .lateral_noise = true});
    const auto [mean, sigma] = moments(camera, kFrames);
    // A place beside the ray by δ is deeper by δ tan(angle).
    const double expected = 2e-3 * std::tan(angle * kDegree);
    EXPECT_NEAR(mean, 1.0, 5 * expected / std::sqrt(kFrames) + 5e-5) << angle;
    EXPECT_NEAR(sigma, expected, expected * 5 / std::sqrt(2.0 * kFrames) + 1e-5) << angle;
  }
}

// The phase of what lies beyond the unambiguous range wraps, and its light is as faint as ever.
TEST(TofNoise, WhatIsFoldedIsAsNoisyAsItsWayIsLong) {
  constexpr int kFrames = 4000;
  Sensor sensor = one_pixel(sensor_preset("sr4000").noise);
  const double way = 1.3 * unambiguous_range(sensor.noise);
  const double sigma = sensor.noise_sigmas(way, 1.0).axial;
  ASSERT_GT(sigma, 3 * sensor.noise_sigmas(0.3 / 1.3 * way, 1.0).axial);
  for (const int sub_rays : {1, 3}) {
    const SimulatedSensor camera(
        tilted_plane(way, 0), sensor,
        {.noise = true, .seed = 4, .sub_rays = sub_rays, .ambiguity = true});
    const auto [mean, seen] = moments(camera, kFrames);
    EXPECT_NEAR(mean, 0.3 / 1.3 * way, 5 * sigma / std::sqrt(kFrames)) << sub_rays;
    EXPECT_NEAR(seen, sigma, 5 * sigma / std::sqrt(2.0 * kFrames)) << sub_rays;
  }
}

// Two thirds of a pixel see a board at 1 m, the others a wall at 4.4 m, on whichever side.
TEST(TofNoise, OfMixedReturnsIsTheSameFromBothSides) {
  constexpr int kFrames = 4000;
  const Sensor sensor = one_pixel(sensor_preset("sr4000").noise);
  std::array<double, 2> sigmas{};
  for (const int side : {-1, 1}) {
    TriangleMesh mesh = test::square_mesh(20, 4.4);
    const double edge = side / 6e5;  // a sixth of a pixel beside the middle
    for (const auto& [x, y] :
         {std::pair{edge, -9.0}, {edge, 9.0}, {-9.0 * side, 9.0}, {-9.0 * side, -9.0}}) {
      mesh.vertices.push_back({x, y, 1.0});
    }
    mesh.triangles.push_back({4, 5, 6});
    mesh.triangles.push_back({4, 6, 7});
    const SimulatedSensor camera(std::make_shared<const SurfaceScene>(std::move(mesh)), sensor,
                                 {.noise = true, .seed = 5, .sub_rays = 3});
    sigmas.at(side < 0 ? 0 : 1) = moments(camera, kFrames).second;
  }
  EXPECT_GT(sigmas[0], 0);
  EXPECT_NEAR(sigmas[1] / sigmas[0], 1, 5 * std::sqrt(1.0 / kFrames));
}

// At the edge of a board: a pixel whose centre is 1 px off it sees the board when its rays are
// displaced by more than that, in each direction of the image. Sigma is a footprint, 1/fx a metre.
TEST(TofNoise, LateralNoiseMovesRaysOverAnEdge) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.cx = 87;
  sensor.camera.cy = 71;
  for (const bool vertical : {false, true}) {
    TriangleMesh mesh = test::square_mesh(20, 1.5);
    const std::uint32_t first = 4;
    for (const auto& [x, y] : {std::pair{-9.0, -9.0}, {0.0, -9.0}, {0.0, 9.0}, {-9.0, 9.0}}) {
      mesh.vertices.push_back(vertical ? std::array{y, x, 1.0} : std::array{x, y, 1.0});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    const SimulatedSensor camera(std::make_shared<const SurfaceScene>(std::move(mesh)), sensor,
                                 {.seed = 8, .lateral_noise = true});
    int near = 0, total = 0;
    for (std::uint64_t index = 0; index < 20; ++index) {
      const DepthFrame frame = camera.acquire(Pose{}, index);
      for (int k = 20; k < 120; ++k, ++total) {
        const float z = vertical ? frame.at(k, 72) : frame.at(88, k);
        near += z < 1.2F ? 1 : 0;
      }
    }
    const double off = 1.0 / (vertical ? sensor.camera.fy : sensor.camera.fx);
    const double expected = 0.5 * std::erfc(off * sensor.camera.fx / std::sqrt(2.0));
    const double tolerance = 5 * std::sqrt(expected * (1 - expected) / total) + 0.01;
    EXPECT_NEAR(static_cast<double>(near) / total, expected, tolerance) << vertical;
  }
}

TEST(TofNoise, AxialSigmaFollowsTheMeasuredIncidence) {
  constexpr int kFrames = 4000;
  for (const int sub_rays : {1, 3}) {
    for (const double angle : {0.0, 60.0, 80.0}) {
      const Sensor sensor = one_pixel(ShotNoise{});
      const SimulatedSensor camera(tilted_plane(1.0, angle * kDegree), sensor,
                                   {.noise = true, .seed = 5, .sub_rays = sub_rays});
      const auto [mean, sigma] = moments(camera, kFrames);
      const double expected = sensor.sigmas(1.0, std::cos(angle * kDegree)).axial;
      EXPECT_NEAR(mean, 1.0, 5 * expected / std::sqrt(kFrames)) << angle;
      EXPECT_NEAR(sigma, expected, expected * 5 / std::sqrt(2.0 * kFrames)) << angle;
    }
  }
}

TEST(TofNoise, AmplitudeIsAsUncertainAsThePhase) {
  const Sensor sensor = sensor_preset("sr4000");
  const SimulationConfig config{.background_radius = 1.5, .noise = true, .seed = 2};
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(test::square_mesh(1, 100)),
                               sensor, config);
  const DepthFrame frame = camera.acquire(Pose{});
  const double relative = 4 * std::numbers::pi * 30e6 / kSpeedOfLight * sensor.sigmas(1.5).axial;
  double sum = 0, squares = 0;
  for (const float amplitude : frame.amplitude) {
    const double z = (amplitude * 2.25 - 1) / relative;
    sum += z;
    squares += z * z;
  }
  const auto n = static_cast<double>(frame.amplitude.size());
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2 / n));
}

TEST(SupportPlane, IsSeenFromAboveAndBelowAndOccludes) {
  const Sensor sensor = sensor_preset("sr4000");
  const auto ball = std::make_shared<const SurfaceScene>(test::sphere_mesh(0.1, 48));
  const SimulatedSensor camera(ball, sensor, {.background_radius = 1.5, .support_plane = -0.05});
  int on_plane = 0, on_ball = 0, on_wall = 0, cases = 0;
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d(0.5, 0, 0.2), Eigen::Vector3d(0.1, 0.1, 0.6), Eigen::Vector3d(0, 0.4, -0.3),
        Eigen::Vector3d(0.02, 0, -0.6)}) {
    const Pose pose = look_at(eye, {0, 0, 0});
    const DepthFrame frame = camera.acquire(pose);
    for (int v = 0; v < frame.height; v += 3) {
      for (int u = 0; u < frame.width; u += 3, ++cases) {
        const Eigen::Vector3d p = pose * (frame.at(u, v) * sensor.camera.ray(u, v));
        // Nothing is seen through the table.
        EXPECT_GT((p.z() + 0.05) * (eye.z() + 0.05), -1e-5);
        const bool plane = std::abs(p.z() + 0.05) < 1e-5;
        const bool wall = std::abs(p.norm() - 1.5) < 1e-5;
        EXPECT_TRUE(plane || wall || p.norm() < 0.1001);
        on_plane += plane ? 1 : 0;
        on_wall += wall ? 1 : 0;
        on_ball += !plane && !wall ? 1 : 0;
        if (plane && eye.z() > 0) {
          // Diffuse: the cosine is that with the vertical.
          const Eigen::Vector3d d = (p - eye).normalized();
          const double amplitude = frame.amplitude[static_cast<std::size_t>(v * frame.width + u)];
          EXPECT_NEAR(amplitude, std::abs(d.z()) / (p - eye).squaredNorm(), 1e-4);
        }
      }
    }
  }
  EXPECT_EQ(cases, 4 * 48 * 59);
  EXPECT_GT(on_plane, 2000);
  EXPECT_GT(on_ball, 500);
  EXPECT_GT(on_wall, 200);

  // From inside the plane it is not seen, and nothing goes wrong.
  const SimulatedSensor level(ball, sensor, {.support_plane = 0.0});
  Eigen::Matrix3d R_world_camera;  // looks along +x
  R_world_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (const float z : level.acquire(Pose(R_world_camera, {1, 0, 0})).depth) {
    EXPECT_FALSE(std::isnan(z));
  }
}

TEST(PixelTruth, IsTheExtentOfTheSubRays) {
  int cases = 0;
  for (const bool distorted : {false, true}) {
    Sensor sensor = sensor_preset("sr4000");
    if (distorted) sensor.camera.distortion = {-0.2, 0.05, 0.001, -0.001, 0};
    const double angle = 50 * kDegree;
    const SimulatedSensor camera(tilted_plane(1.0, angle), sensor, {.sub_rays = 3});
    std::vector<SimulatedSensor::PixelTruth> truth;
    const DepthFrame frame = camera.acquire(Pose{}, 0, truth);
    EXPECT_EQ(frame, camera.acquire(Pose{}));
    ASSERT_EQ(truth.size(), frame.depth.size());
    for (int v = 0; v < frame.height; v += 7) {
      for (int u = 0; u < frame.width; u += 7, ++cases) {
        double low = 1e9, high = 0, nearest = 1e9;
        const auto i = static_cast<std::size_t>(v * frame.width + u);
        const double reading = frame.depth[i] * sensor.camera.ray(u, v).norm();
        for (const double dv : {-1.0 / 3, 0.0, 1.0 / 3}) {
          for (const double du : {-1.0 / 3, 0.0, 1.0 / 3}) {
            // The plane is z = 1 + x tan(angle).
            const Eigen::Vector3d ray = sensor.camera.ray(u + du, v + dv);
            const double range = ray.norm() / (1 - ray.x() * std::tan(angle));
            low = std::min(low, range);
            high = std::max(high, range);
            if (std::abs(range - reading) < std::abs(nearest - reading)) nearest = range;
          }
        }
        EXPECT_NEAR(truth[i].min_range, low, 2e-5);
        EXPECT_NEAR(truth[i].max_range, high, 2e-5);
        EXPECT_NEAR(truth[i].nearest_range, nearest, 2e-5);
        EXPECT_EQ(truth[i].returns, 9);
      }
    }
  }
  EXPECT_EQ(cases, 2 * 21 * 26);
}

TEST(TofNoise, TheSameForAnyNumberOfThreadsAndReproducible) {
  Sensor sensor = sensor_preset("sr4000");
  SimulationConfig config{.background_radius = 1.5,
                          .noise = true,
                          .seed = 11,
                          .sub_rays = 2,
                          .lateral_noise = true,
                          .support_plane = -0.1};
  const auto ball = std::make_shared<const SurfaceScene>(test::sphere_mesh(0.1, 24));
  const Pose pose = look_at({0.5, 0.1, 0.2}, {0, 0, 0});
  std::vector<SimulatedSensor::PixelTruth> truth, other_truth;
  const DepthFrame first = SimulatedSensor(ball, sensor, config, {1}).acquire(pose, 7, truth);
  for (const int threads : {1, 2, 3, 5}) {
    const SimulatedSensor camera(ball, sensor, config, {threads});
    EXPECT_EQ(camera.acquire(pose, 7, other_truth), first);
    EXPECT_NE(camera.acquire(pose, 8), first);
    ASSERT_EQ(other_truth.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_EQ(other_truth[i].min_range, truth[i].min_range);
      EXPECT_EQ(other_truth[i].nearest_range, truth[i].nearest_range);
    }
  }
  config.seed = 12;
  EXPECT_NE(SimulatedSensor(ball, sensor, config).acquire(pose, 7), first);
}

}  // namespace
}  // namespace viewgain
