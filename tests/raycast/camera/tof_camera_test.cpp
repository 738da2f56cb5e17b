// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Amplitudes, mixed returns, ambiguity and systematic error of the simulated camera.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/comma_locale.hpp"
#include "core/expect_error.hpp"
#include "support/meshes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain {
namespace {

constexpr double kPeriod = kSpeedOfLight / (2 * 30e6);  // of the SR4000's ranges [m]

std::shared_ptr<const SurfaceScene> plane_at(double z, double half = 20) {
  return std::make_shared<const SurfaceScene>(test::square_mesh(half, z));
}

/// A small board in front of another: x < edge at z = near, the rest at z = far.
std::shared_ptr<const SurfaceScene> step(double near, double far, double edge) {
  TriangleMesh mesh = test::square_mesh(0.1, far);
  mesh.vertices.insert(
      mesh.vertices.end(),
      {{-0.1, -0.1, near}, {edge, -0.1, near}, {edge, 0.1, near}, {-0.1, 0.1, near}});
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  return std::make_shared<const SurfaceScene>(std::move(mesh));
}

/// One pixel on the optical axis whose rays are all but parallel.
Sensor one_pixel(const char* preset = "sr4000") {
  Sensor sensor = sensor_preset(preset);
  sensor.camera = {
      .width = 1, .height = 1, .fx = 1e3, .fy = 1e3, .cx = 0, .cy = 0, .distortion = {}};
  return sensor;
}

Pose back_by(double distance) { return {Eigen::Matrix3d::Identity(), {0, 0, -distance}}; }

TEST(TofCamera, AmplitudeIsCosineOverSquaredRange) {
  const Sensor sensor = sensor_preset("sr4000");
  const DepthFrame frame = SimulatedSensor(plane_at(0.75), sensor).acquire(Pose{});
  ASSERT_EQ(frame.amplitude.size(), frame.depth.size());
  int cases = 0;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u, ++cases) {
      const double t = 0.75 * sensor.camera.ray(u, v).norm();
      const double amplitude = frame.amplitude[static_cast<std::size_t>(v * frame.width + u)];
      EXPECT_NEAR(amplitude, 0.75 / (t * t * t), 1e-5);
    }
  }
  EXPECT_EQ(cases, 176 * 144);
  // Evenly covered pixels hardly differ from their centres.
  const DepthFrame mixed = SimulatedSensor(plane_at(0.75), sensor, {.sub_rays = 3}).acquire(Pose{});
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    EXPECT_NEAR(mixed.amplitude[i], frame.amplitude[i], 1e-4);
    EXPECT_NEAR(mixed.depth[i], frame.depth[i], 1e-5);
  }
}

TEST(TofCamera, TooDarkIsInvalid) {
  Sensor sensor = sensor_preset("sr4000");
  // The amplitude on the plane is 0.75 / t³: under 1.6 beyond 0.7769 m.
  sensor.noise = ShotNoise{.min_amplitude = 1.6};
  const DepthFrame frame = SimulatedSensor(plane_at(0.75), sensor).acquire(Pose{});
  const double limit = std::cbrt(0.75 / 1.6);
  int dark = 0;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const double t = 0.75 * sensor.camera.ray(u, v).norm();
      if (std::abs(t - limit) < 1e-5) continue;
      const auto i = static_cast<std::size_t>(v * frame.width + u);
      EXPECT_EQ(frame.depth[i] == DepthFrame::kInvalid, t > limit);
      EXPECT_EQ(frame.amplitude[i] == 0, t > limit);
      dark += t > limit ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 5000);
  EXPECT_LT(dark, 20'000);
  // No threshold without shot noise.
  sensor.noise = ConstantNoise{};
  for (const float z : SimulatedSensor(plane_at(4.9), sensor).acquire(Pose{}).depth) {
    EXPECT_GT(z, 0);
  }
}

TEST(TofCamera, ReturnsMixAsPhasors) {
  const Sensor sensor = one_pixel();
  int readings = 0;
  for (const auto& [near, far] :
       {std::pair{0.5, 0.7}, std::pair{0.45, 1.9}, std::pair{1.0, 2.9}, std::pair{0.3, 4.6}}) {
    for (const int covered : {0, 3, 8, 13, 16}) {  // columns of sub-rays that meet the near board
      const double edge = near * (covered / 16.0 - 0.5) / sensor.camera.fx;
      const DepthFrame frame =
          SimulatedSensor(step(near, far, edge), sensor, {.sub_rays = 16}).acquire(Pose{});
      const auto phasor = [](double t, double share) {
        return std::polar(share / (t * t), 4 * std::numbers::pi * 30e6 * t / kSpeedOfLight);
      };
      const std::complex<double> sum =
          phasor(near, covered / 16.0) + phasor(far, 1 - covered / 16.0);
      double phase = std::arg(sum);
      if (phase < 0) phase += 2 * std::numbers::pi;
      const double expected = phase / (2 * std::numbers::pi) * kPeriod;
      if (expected < sensor.min_range) {
        EXPECT_EQ(frame.depth[0], DepthFrame::kInvalid);
      } else {
        EXPECT_NEAR(frame.depth[0], expected, 1e-5) << near << " " << far << " " << covered;
        EXPECT_NEAR(frame.amplitude[0], std::abs(sum), 1e-5);
        ++readings;
      }
    }
  }
  EXPECT_GE(readings, 18);
}

TEST(TofCamera, NothingAddsNothing) {
  const Sensor sensor = one_pixel();
  // Half of the pixel sees the board, half nothing: the range is the board's, the light is half.
  TriangleMesh half = test::square_mesh(1, 0.8);
  for (auto& vertex : half.vertices) vertex[0] -= 1;
  const auto scene = std::make_shared<const SurfaceScene>(std::move(half));
  std::vector<SimulatedSensor::PixelTruth> truth;
  const DepthFrame frame =
      SimulatedSensor(scene, sensor, {.sub_rays = 4}).acquire(Pose{}, 0, truth);
  EXPECT_NEAR(frame.depth[0], 0.8, 1e-6);
  EXPECT_NEAR(frame.amplitude[0], 0.5 / 0.64, 1e-5);
  EXPECT_EQ(truth.at(0).returns, 8);
  const DepthFrame nothing =
      SimulatedSensor(plane_at(-1), sensor, {.sub_rays = 4}).acquire(Pose{}, 0, truth);
  EXPECT_EQ(nothing.depth[0], DepthFrame::kOutOfRange);
  EXPECT_EQ(nothing.amplitude[0], 0);
  EXPECT_EQ(truth.at(0).returns, 0);
}

TEST(TofCamera, RangesFoldBackWherePhasesAreMeasured) {
  for (const double range : {4.9, 6.0, 9.7, 11.5}) {
    const double folded = range - kPeriod * std::floor(range / kPeriod);
    const auto read = [&](const Sensor& sensor, const SimulationConfig& config) {
      return SimulatedSensor(plane_at(0), sensor, config).acquire(back_by(range)).depth[0];
    };
    Sensor sensor = one_pixel();
    sensor.noise = ShotNoise{.min_amplitude = 0.001};
    // A single ray tells the range as it is, unless asked to fold.
    const float plain = read(sensor, {});
    if (range > sensor.max_range) {
      EXPECT_EQ(plain, DepthFrame::kOutOfRange);
    } else {
      EXPECT_NEAR(plain, range, 1e-5);
    }
    EXPECT_NEAR(read(sensor, {.ambiguity = true}), folded, 1e-5);
    EXPECT_NEAR(read(sensor, {.sub_rays = 3}), folded, 1e-5);
    // Without a modulation frequency neither does anything.
    sensor.noise = ShotNoise{.modulation_frequency = 0, .min_amplitude = 0.001};
    EXPECT_EQ(read(sensor, {.sub_rays = 3, .ambiguity = true}), plain);
    sensor.noise = ConstantNoise{};
    EXPECT_EQ(read(sensor, {.sub_rays = 3, .ambiguity = true}), plain);
  }
  // A fold that ends under min_range is no reading.
  const Sensor sensor = one_pixel();
  EXPECT_EQ(SimulatedSensor(plane_at(0), sensor, {.ambiguity = true})
                .acquire(back_by(kPeriod + 0.1))
                .depth[0],
            DepthFrame::kInvalid);
}

TEST(TofCamera, SensorsWithoutPhaseSeeTheCentreRay) {
  const Sensor sensor = sensor_preset("kinect_v1");
  const auto scene = step(0.8, 1.5, 0.001);
  const SimulationConfig plain{.background_radius = 3};
  SimulationConfig sub_rays = plain;
  sub_rays.sub_rays = 5;
  EXPECT_EQ(SimulatedSensor(scene, sensor, plain).acquire(Pose{}),
            SimulatedSensor(scene, sensor, sub_rays).acquire(Pose{}));
}

TEST(TofCamera, RefusesBadConfigurations) {
  const auto scene = plane_at(1);
  const Sensor sensor = sensor_preset("sr4000");
  const auto refused = [&](const Sensor& s, const SimulationConfig& config, const char* word) {
    test::expect_error(ErrorCode::invalid_argument, word,
                       [&] { SimulatedSensor camera(scene, s, config); });
  };
  refused(sensor, {.sub_rays = 0}, "0");
  refused(sensor, {.sub_rays = 17}, "17");
  refused(sensor, {.support_plane = std::nan("")}, "nan");
}

}  // namespace
}  // namespace viewgain
