// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Frames are made by the formula of the plane and of the error, which the calibration is to find.
#include "calibration/wall_calibration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "core/random_values.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using ErrorCurve = std::function<double(double)>;  // of the true range [m]

// A wall at `distance` on the optical axis; its normal is turned about y and x by the slopes.
struct WallPose {
  double distance = 1;
  double slope_x = 0, slope_y = 0;  // tan of the angles

  [[nodiscard]] Eigen::Vector3d normal() const { return {slope_x, slope_y, 1}; }
};

double wiggling(double range) {
  return 0.01 * std::sin(4 * 2 * std::numbers::pi * range /
                         unambiguous_range(sensor_preset("sr4000").noise));
}

// `noise` is in the sensor's own sigmas.
DepthFrame frame_of(const Sensor& sensor, const WallPose& wall, const ErrorCurve& error,
                    double noise, test::RandomValues& random) {
  DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
  for (const Eigen::Vector3d& ray : sensor.camera.ray_table()) {
    const double along = wall.normal().dot(ray);
    const double range = wall.distance * ray.norm() / along;
    if (!(along > 0) || range > sensor.max_range) {
      frame.depth.push_back(DepthFrame::kInvalid);
      continue;
    }
    const double cosine = along / (wall.normal().norm() * ray.norm());
    const double sigma = noise * sensor.sigmas(range, cosine).axial;
    const double reading = range + error(range) + (noise > 0 ? sigma * random.normal() : 0.0);
    const bool is_in_range = reading >= sensor.min_range && reading <= sensor.max_range;
    frame.depth.push_back(is_in_range ? static_cast<float>(reading / ray.norm())
                                      : DepthFrame::kInvalid);
  }
  return frame;
}

// Ten walls turned by up to 38 degrees to either side, from near to far.
std::vector<WallPose> slanted_walls() {
  std::vector<WallPose> walls;
  for (int i = 0; i < 10; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    walls.push_back({0.5 * std::pow(4.0, i / 9.0), side * (0.7 + 0.01 * i), 0.03 * (i % 3 - 1)});
  }
  return walls;
}

// Root mean square and largest error of corrected ranges, evenly over what the table was made of.
std::pair<double, double> what_is_left(const WallCalibrationResult& result,
                                       const ErrorCurve& error) {
  double squares = 0, largest = 0;
  constexpr int kRanges = 2000;
  for (int i = 0; i <= kRanges; ++i) {
    const double range = result.nearest + (result.farthest - result.nearest) * i / kRanges;
    const double off = result.calibration.corrected(range + error(range)) - range;
    squares += off * off;
    largest = std::max(largest, std::abs(off));
  }
  return {std::sqrt(squares / (kRanges + 1)), largest};
}

std::uint64_t all_readings(const WallFrameFigures& frame) {
  return frame.used + frame.border + frame.sparse + frame.limits + frame.off_wall;
}

TEST(WallCalibration, FindsAWigglingErrorFromTenFramesOfUnknownTilt) {
  const Sensor sensor = sensor_preset("sr4000");
  test::RandomValues random(3);
  WallCalibration calibration(sensor);
  const std::vector<WallPose> walls = slanted_walls();
  for (std::size_t i = 0; i < walls.size(); ++i) {
    calibration.add(frame_of(sensor, walls[i], wiggling, 1, random), walls[i].distance,
                    std::to_string(i));
  }
  const WallCalibrationResult result = calibration.solve();
  const auto [rms, largest] = what_is_left(result, wiggling);
  EXPECT_LT(rms, 0.7e-3);
  EXPECT_LT(largest, 3e-3);
  EXPECT_LT(result.nearest, 0.45);
  EXPECT_GT(result.farthest, 2.7);
  EXPECT_GT(result.rms_before, 5e-3);
  ASSERT_TRUE(result.rms_after);
  EXPECT_LT(*result.rms_after, 1.5e-3);
  ASSERT_EQ(result.frames.size(), walls.size());
  int cases = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const WallFrameFigures& frame = result.frames[i];
    EXPECT_EQ(frame.name, std::to_string(i));
    EXPECT_NEAR(frame.distance, walls[i].distance, 1e-9);
    EXPECT_NEAR(frame.tilt, std::acos(1 / walls[i].normal().norm()), 0.01) << i;
    EXPECT_LT(frame.off_wall, 0.05 * static_cast<double>(frame.used)) << i;
    ++cases;
  }
  EXPECT_EQ(cases, 10);
  // The same readings give the same table.
  EXPECT_EQ(calibration.solve().calibration, result.calibration);
}

TEST(WallCalibration, IsNearlyExactWithoutNoiseAndWithKnownWalls) {
  const Sensor sensor = sensor_preset("sr4000");
  test::RandomValues random(5);
  const std::vector<ErrorCurve> errors{[](double) { return 0.0; }, [](double) { return 0.03; },
                                       wiggling,
                                       [](double t) { return -0.02 + 0.01 * t * t / 10; }};
  for (const ErrorCurve& error : errors) {
    WallCalibration calibration(sensor);
    for (const WallPose& wall : slanted_walls()) {
      // The normal's length and sign do not count.
      calibration.add(frame_of(sensor, wall, error, 0, random), -2 * wall.normal(),
                      -2 * wall.distance, "wall");
    }
    const WallCalibrationResult result = calibration.solve();
    const auto [rms, largest] = what_is_left(result, error);
    EXPECT_LT(rms, 0.1e-3);
    EXPECT_LT(largest, 0.6e-3);
  }
}

TEST(WallCalibration, LeavesOutWhatIsNotTheWall) {
  const Sensor sensor = sensor_preset("sr4000");
  test::RandomValues random(7);
  WallCalibration calibration(sensor);
  std::uint64_t readings = 0;
  for (const WallPose& wall : slanted_walls()) {
    DepthFrame frame = frame_of(sensor, wall, wiggling, 1, random);
    // A box stands before a fifth of the wall; a corner of the image has no readings.
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u) {
        float& depth = frame.depth[static_cast<std::size_t>(v * frame.width + u)];
        if (u > 120 && v > 50) depth = 0.5F * static_cast<float>(wall.distance);
        if (u < 30 && v < 30) depth = DepthFrame::kInvalid;
        readings += depth > 0 ? 1 : 0;
      }
    }
    calibration.add(frame, wall.distance, "wall");
  }
  const WallCalibrationResult result = calibration.solve();
  EXPECT_LT(what_is_left(result, wiggling).first, 1e-3);
  std::uint64_t counted = 0;
  for (const WallFrameFigures& frame : result.frames) {
    EXPECT_GT(frame.off_wall, 3000U);
    EXPECT_GT(frame.border, 500U);
    counted += all_readings(frame);
  }
  EXPECT_EQ(counted, readings);
}

TEST(WallCalibration, TakesOneRowOfPixelsAndASmallImage) {
  test::RandomValues random(9);
  Sensor small = sensor_preset("sr4000");
  small.camera = {24, 18, 27.5, 28.9, 11.5, 8.5, {}};
  for (const Sensor& sensor : {sensor_preset("laser_line"), small}) {
    const auto error = [](double t) { return 0.004 * std::sin(6 * t); };
    WallCalibration calibration(sensor);
    for (int i = 0; i < 10; ++i) {
      const WallPose wall{0.25 + 0.05 * i, i % 2 == 0 ? 0.5 : -0.5, 0};
      calibration.add(frame_of(sensor, wall, error, 0.1, random), wall.distance, "wall");
    }
    EXPECT_LT(what_is_left(calibration.solve(), error).first, 0.5e-3) << sensor.name;
  }
}

// Without a range that two frames share nothing can be told of what is left.
TEST(WallCalibration, SaysWhatItCannotTell) {
  const Sensor sensor = sensor_preset("sr4000");
  test::RandomValues random(11);
  WallCalibration calibration(sensor);
  for (const double distance : {0.5, 2.0}) {
    calibration.add(frame_of(sensor, {distance, 0, 0}, wiggling, 0, random), distance, "wall");
  }
  const WallCalibrationResult result = calibration.solve();
  EXPECT_FALSE(result.rms_after);
  EXPECT_GT(result.widest_gap, 1.3);
  EXPECT_NEAR(result.calibration.corrected(0.5 + wiggling(0.5)), 0.5, 1e-3);
  EXPECT_NEAR(result.calibration.corrected(2.0 + wiggling(2.0)), 2.0, 1e-3);
}

TEST(WallCalibration, RefusesAFrameThatDoesNotFitToTheOthers) {
  const Sensor sensor = sensor_preset("sr4000");
  test::RandomValues random(12);
  WallCalibration calibration(sensor);
  const std::vector<WallPose> walls = slanted_walls();
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double mistake = i == 4 ? 0.1 : 0.0;
    calibration.add(frame_of(sensor, walls[i], wiggling, 1, random), walls[i].distance + mistake,
                    "frame " + std::to_string(i));
  }
  expect_error(ErrorCode::invalid_argument, "frame 4: most of its readings do not fit",
               [&] { (void)calibration.solve(); });
}

TEST(WallCalibration, RefusesFramesThatCannotBe) {
  const Sensor sensor = sensor_preset("sr4000");
  test::RandomValues random(13);
  const auto none = [](double) { return 0.0; };
  const DepthFrame wall = frame_of(sensor, {1, 0, 0}, none, 1, random);
  WallCalibration calibration(sensor);
  const auto refused = [&](const char* part, const auto& call) {
    expect_error(ErrorCode::invalid_argument, part, call);
  };
  refused("not 0 in all", [&] { (void)calibration.solve(); });
  calibration.add(wall, 1, "a");
  refused("not 1 in all", [&] { (void)calibration.solve(); });
  calibration.add(wall, 1, "b");
  refused("all are at 1 m", [&] { (void)calibration.solve(); });

  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double distance : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    refused("c: the wall's distance", [&] { calibration.add(wall, distance, "c"); });
  }
  for (const double distance : {0.75, 1.3, 1000.0}) {
    refused("c: reads the wall at 1 m", [&] { calibration.add(wall, distance, "c"); });
  }
  refused("c: its readings are not of the wall", [&] {
    calibration.add(wall, {0.0, 0.0, 1.0}, 1.4, "c");
  });
  refused("c: its readings are not of the wall", [&] {
    calibration.add(wall, {0.0, 0.0, -1.0}, 1.0, "c");
  });
  refused("c: its readings are not of the wall", [&] {
    calibration.add(wall, {1.0, 0.0, 0.2}, 1.0, "c");
  });
  refused("c: the wall is no plane", [&] { calibration.add(wall, {0.0, 0.0, 0.0}, 1.0, "c"); });
  refused("c: the wall is no plane", [&] { calibration.add(wall, {0.0, 0.0, 1.0}, 0.0, "c"); });
  refused("c: the wall is no plane", [&] { calibration.add(wall, {kNan, 0.0, 1.0}, 1.0, "c"); });

  // Two walls that meet at the middle of the image, and a ball.
  DepthFrame corner = frame_of(sensor, {1, 0.8, 0}, none, 0, random);
  const DepthFrame other = frame_of(sensor, {1, -0.8, 0}, none, 0, random);
  DepthFrame ball = wall;
  const std::vector<Eigen::Vector3d> rays = sensor.camera.ray_table();
  for (std::size_t i = 0; i < corner.depth.size(); ++i) {
    corner.depth[i] = std::min(corner.depth[i], other.depth[i]);
    const double b = rays[i].normalized().z(), c = 1 - 0.4 * 0.4;  // radius 0.4 m at 1 m
    ball.depth[i] =
        b * b > c ? static_cast<float>((b - std::sqrt(b * b - c)) * b) : DepthFrame::kInvalid;
  }
  refused("c: no flat wall", [&] { calibration.add(corner, 1, "c"); });
  refused("c: no flat wall", [&] { calibration.add(ball, 0.6, "c"); });

  DepthFrame empty = wall;
  empty.depth.assign(empty.depth.size(), DepthFrame::kInvalid);
  refused("c: has hardly any readings", [&] { calibration.add(empty, 1, "c"); });
  const DepthFrame far = frame_of(sensor, {4.9, 0, 0}, none, 0, random);
  refused("within the sensor's range limits", [&] { calibration.add(far, 4.9, "c"); });
  empty.width = 3;
  refused("3", [&] { calibration.add(empty, 1, "c"); });
}

}  // namespace
}  // namespace viewgain
