// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The error by range with which frames of a wall were made is found in them, and frames that cannot
// tell it are refused or named.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "calibration/range_fit.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// 10 mm of a wave over 0.9 m, and an offset [m].
double error_at(double range) {
  return 0.010 * std::sin(2 * std::numbers::pi * range / 0.9) + 0.006;
}
double no_error(double) { return 0; }

struct View {
  double distance, pan, tilt;  // [m], [deg]
};

class CalibrateRange : public test::ProgramTest {
 protected:
  CalibrateRange() {
    write_small_sensor();
    sensor = read_sensor_toml(dir / "small.toml");
    sensor.min_range = 0.2, sensor.max_range = 5;
    for (int i = 0; i < 12; ++i) {
      views.push_back({0.5 + 0.16 * i, (i % 3 - 1) * 15.0, (i % 4) * 6.0 - 9});
    }
  }

  static Pose pose_of(const View& view) {
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(view.pan * kDegree, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(view.tilt * kDegree, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    return {turn, {0.1 * view.distance, -0.05, 3 - view.distance}};
  }

  // Of the wall z = 3 + sag x² [m], with noise along the ray.
  [[nodiscard]] DepthFrame frame_of(const View& view, const std::function<double(double)>& error,
                                    double sag = 0) {
    const Pose T = pose_of(view);
    DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
    std::normal_distribution<double> noise(0, sigma);
    for (const Eigen::Vector3d& ray : sensor.camera.ray_table()) {
      const Eigen::Vector3d along = T.rotation() * ray.normalized();
      double range = (3 - T.translation().z()) / along.z();
      const double x = T.translation().x() + range * along.x();
      range = (3 + sag * x * x - T.translation().z()) / along.z();
      frame.depth.push_back(
          static_cast<float>((range + error(range) + noise(random)) / ray.norm()));
    }
    return frame;
  }

  [[nodiscard]] RangeFitResult fit(const std::function<double(double)>& error, double sag = 0) {
    RangeFit fit(sensor);
    for (const View& view : views) {
      fit.add(frame_of(view, error, sag), pose_of(view), std::to_string(view.distance));
    }
    return fit.solve();
  }
  void expect_refused_fit(const std::string& word, double sag = 0) {
    expect_error([&] { (void)fit(&error_at, sag); }, word);
  }
  static void expect_error(const std::function<void()>& call, const std::string& word) {
    try {
      call();
      ADD_FAILURE() << word;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  // What the table leaves of the error, over the ranges that were seen.
  static double left_by(const Sensor& found, const std::function<double(double)>& error) {
    double squares = 0;
    int count = 0;
    for (double range = 0.55; range < 2.3; range += 0.01, ++count) {
      const double left = found.range_calibration.corrected(range + error(range)) - range;
      squares += left * left;
    }
    return std::sqrt(squares / count);
  }
  static double mean_left_by(const Sensor& found, const std::function<double(double)>& error) {
    double sum = 0;
    int count = 0;
    for (double range = 0.55; range < 2.3; range += 0.01, ++count) {
      sum += found.range_calibration.corrected(range + error(range)) - range;
    }
    return sum / count;
  }

  Sensor sensor;
  std::vector<View> views;
  double sigma = 0.002;  // of the noise [m]
  std::mt19937 random{5};
};

TEST_F(CalibrateRange, WavesAndOffsetsAreFound) {
  const RangeFitResult result = fit(&error_at);
  EXPECT_EQ(result.distances, 12U);
  EXPECT_GT(result.rms_before, 0.005);
  EXPECT_LT(result.rms_after, 0.001);
  EXPECT_TRUE(result.left_out.empty());
  RecordProperty("left_mm", std::to_string(1e3 * left_by(result.sensor, &error_at)));
  EXPECT_LT(left_by(result.sensor, &error_at), 0.001);
  EXPECT_LT(left_by(fit(&no_error).sensor, &no_error), 0.001);
}

TEST_F(CalibrateRange, NoiseDoesNotBiasTheTable) {
  sigma = 0.005;
  expect_refused_fit("the constant part of the range error is uncertain");  // too few pixels, but
                                                                            // not bent
  sensor.camera = {176, 144, 220, 220, 87.5, 71.5};
  for (const double noise : {0.002, 0.005}) {
    sigma = noise;
    for (const auto& error : {&error_at, &no_error}) {
      const RangeFitResult result = fit(error);
      EXPECT_LT(left_by(result.sensor, error), 0.001) << noise;
      EXPECT_LT(std::abs(mean_left_by(result.sensor, error)), 0.001) << noise;
      EXPECT_LT(std::abs(mean_left_by(result.sensor, error)), 3 * result.offset_sigma) << noise;
    }
  }
}

// A lens of 44 deg, so that hardly more than the turns tell the offset.
TEST_F(CalibrateRange, WeakTurnsAreEnoughOrRefused) {
  sensor.camera = {176, 144, 220, 220, 87.5, 71.5};
  const std::vector<View> good = views;
  int refused = 0, solved = 0;
  for (const double noise : {0.001, 0.002, 0.005}) {
    sigma = noise;
    for (const double share : {0.0, 0.2, 0.4, 1.0}) {
      for (std::size_t i = 0; i < good.size(); ++i) {
        views[i] = {good[i].distance, share * good[i].pan, share * good[i].tilt};
      }
      try {
        const RangeFitResult result = fit(&error_at);
        ++solved;
        EXPECT_LT(left_by(result.sensor, &error_at), 0.001) << noise << ' ' << share;
        EXPECT_LT(result.offset_sigma, 0.0005);
      } catch (const Error& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("Turn the camera by 10 to 30 deg at more"),
                  std::string::npos)
            << error.what();
        EXPECT_LT(share, 1) << noise;
      }
    }
  }
  EXPECT_GE(solved, 6);
  EXPECT_GE(refused, 1);
}

TEST_F(CalibrateRange, WhatDoesNotTellItIsRefusedOrNamed) {
  const std::vector<View> good = views;
  expect_refused_fit("the wall is not flat", 0.05);
  views.resize(7);
  expect_refused_fit("at least 8 different distances are required, not 7");
  views.assign(20, good[3]);
  expect_refused_fit("different distances are required, not 1");

  RangeFit turned(sensor), saturated(sensor);
  DepthFrame bright = frame_of(good[0], &error_at);
  bright.amplitude.assign(bright.depth.size(), DepthFrame::kSaturated);
  for (const View& view : good) {
    turned.add(frame_of(view, &error_at),
               pose_of({view.distance, view.pan, view.tilt + (&view == &good[4] ? 20 : 0)}),
               "frame " + std::to_string(&view - good.data()));
    saturated.add(frame_of(view, &error_at), pose_of(view), "good");
  }
  expect_error([&] { (void)turned.solve(); },
               "frame 4 shows a different wall than the other frames");
  saturated.add(bright, pose_of(good[0]), "bright");
  saturated.add(frame_of({1, 60, 0}, &error_at), pose_of({1, 60, 0}), "slanted");
  DepthFrame no_wall = frame_of(good[0], &error_at);
  for (std::size_t i = 0; i < no_wall.depth.size(); i += 2) no_wall.depth[i] *= 0.5F;
  saturated.add(no_wall, pose_of(good[0]), "cluttered");
  const RangeFitResult result = saturated.solve();
  ASSERT_EQ(result.left_out.size(), 3U);
  EXPECT_EQ(result.left_out[0], "bright: 1728 pixels are saturated");
  EXPECT_EQ(result.left_out[1],
            "slanted: the wall is seen at an angle of 60 deg; the maximum is 45 deg");
  EXPECT_EQ(result.left_out[2], "cluttered: no flat wall fills most of the image");
  expect_error(
      [&] {
        saturated.add({2, 2, {1, 1, 1, 1}}, {}, "small");
      },
      "small: the image and the sensor have different sizes");
}

TEST_F(CalibrateRange, ByTheProgram) {
  FramesWriter writer(dir / "wall");
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < views.size(); ++i) {
    poses.push_back(pose_of(views[i]));
    writer.write_frame(i, frame_of(views[i], &error_at));
  }
  sensor.range_calibration.table = {{1, 0.5}, {2, 0.5}};  // an earlier one does not count
  writer.commit(poses, sensor);
  const json report =
      json::parse(run_well({"calibrate", "--range", "wall", "--out", "found.toml", "--json"}));
  EXPECT_EQ(report["frames"], 12);
  EXPECT_LT(report["rms_after"], 0.001);
  EXPECT_EQ(report["steps"].size(), 12);
  EXPECT_LT(left_by(read_sensor_toml(dir / "found.toml"), &error_at), 0.001);
  const std::string text = run_well({"calibrate", "--range", "wall", "--out", "found.toml"});
  EXPECT_NE(text.find("12 frames at 12 distances: RMS range error "), std::string::npos) << text;
  expect_refused(
      {{{"calibrate", "wall", "--out", "new.toml"}, "give either --noise or --range"},
       {{"calibrate", "wall", "--noise", "--range", "--out", "new.toml"}, "give either"}});
}

}  // namespace
}  // namespace viewgain
