// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The noise with which a static scene was simulated is found in its frames. The sensor that the
// calibration begins with is wrong by a factor of two.
#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

class CalibrateNoise : public test::ProgramTest {
 protected:
  CalibrateNoise() {
    write_half_sensor();
    Scene wall;
    wall.add({0, 0, 1.5}, 3, 3, 0, 0.2);
    write("wall.off", wall.off());
    wall.add({-0.16, -0.02, 0.8}, 0.08, 0.12, 0.3, 0);
    wall.add({0.2, 0.03, 1.1}, 0.12, 0.17, -0.2, 0);
    write("scene.off", wall.off());
  }

  // Rectangles before the camera, which looks along z.
  struct Scene {
    std::vector<Eigen::Vector3d> corners;

    void add(const Eigen::Vector3d& middle, double half_width, double half_height, double turn,
             double slope) {
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        const double along = x * half_width, up = y * half_height;
        const double right = along * std::cos(turn) - up * std::sin(turn);
        corners.emplace_back(middle + Eigen::Vector3d(right,
                                                      along * std::sin(turn) + up * std::cos(turn),
                                                      slope * right));
      }
    }
    [[nodiscard]] std::string off() const {
      std::ostringstream text;
      text << "OFF\n" << corners.size() << ' ' << corners.size() / 4 << " 0\n";
      for (const Eigen::Vector3d& p : corners) text << p.transpose() << '\n';
      for (std::size_t i = 0; i < corners.size(); i += 4) {
        text << "4 " << i << ' ' << i + 1 << ' ' << i + 2 << ' ' << i + 3 << '\n';
      }
      return text.str();
    }
  };

  void simulate(const std::string& mesh, const std::vector<double>& places, int frames_per_view,
                const std::string& sensor, int seed, const std::string& noise,
                const std::string& out) const {
    std::vector<Pose> poses;
    for (const double x : places) {
      poses.emplace_back(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0, 0));
    }
    write_tum(dir / "poses.txt", poses);
    run_well({"simulate", mesh, "--poses", "poses.txt", "--sensor", sensor, "--noise", noise,
              "--seed", std::to_string(seed), "--frames-per-view", std::to_string(frames_per_view),
              "--background", "0", "--out", out});
  }

  // Simulates with `truth` and calibrates beginning with `guess`.
  [[nodiscard]] Sensor calibrated(const NoiseModel& truth, const NoiseModel& guess, int seed,
                                  json* report = nullptr) const {
    Sensor sensor = read_sensor_toml(dir / "tof.toml");
    sensor.noise = truth;
    write_sensor_toml(dir / "true.toml", sensor);
    sensor.noise = guess;
    write_sensor_toml(dir / "guess.toml", sensor);
    simulate("scene.off", {0}, 40, "true.toml", seed, "on", "static");
    std::filesystem::remove(dir / "static/poses.txt");
    const json said =
        json::parse(run_well({"calibrate", "--noise", "static", "--sensor", "guess.toml",
                              "--depth-scale", "1e-4", "--out", "found.toml", "--json"}));
    if (report != nullptr) *report = said;
    return read_sensor_toml(dir / "found.toml");
  }
};

constexpr double kClose = 0.06;  // of a sigma

void expect_axial(const Sensor& found, const NoiseModel& truth, int& cases) {
  for (const double range : {0.8, 1.1, 1.5}) {
    const double expected = sigmas(truth, range, found.camera.fx).axial;
    EXPECT_NEAR(found.noise_sigmas(range).axial, expected, kClose * expected) << range;
    ++cases;
  }
}

TEST_F(CalibrateNoise, OfEachModelIsFound) {
  const NoiseModel shot = read_sensor_toml(dir / "tof.toml").noise;
  ShotNoise shot_guess = std::get<ShotNoise>(shot);
  shot_guess.reference_sigma *= 2;
  const StructuredLightNoise light;
  StructuredLightNoise light_guess = light;
  light_guess.offset *= 2;
  light_guess.quadratic *= 0.5;
  light_guess.lateral_px = 0.4;
  const ConstantNoise constant{0.004, 0.008};
  int cases = 0;
  for (const int seed : {1, 2, 3}) {
    json report;
    expect_axial(calibrated(shot, shot_guess, seed, &report), shot, cases);
    EXPECT_FALSE(report.at("lateral_in_model").get<bool>());
    EXPECT_NEAR(report.at("sigma_lateral_px").get<double>(), 1, kClose);
    EXPECT_EQ(report.at("frames"), 40);

    Sensor found = calibrated(light, light_guess, seed, &report);
    expect_axial(found, light, cases);
    EXPECT_TRUE(report.at("ranges_tell_shape").get<bool>());
    EXPECT_NEAR(std::get<StructuredLightNoise>(found.noise).lateral_px, light.lateral_px,
                kClose * light.lateral_px);

    found = calibrated(constant, ConstantNoise{0.002, 0.004}, seed);
    expect_axial(found, constant, cases);
    EXPECT_NEAR(std::get<ConstantNoise>(found.noise).sigma_lateral, constant.sigma_lateral,
                kClose * constant.sigma_lateral);
  }
  EXPECT_EQ(cases, 27);
}

// Stereo has 1 px of noise across the ray, the camera half of that.
TEST_F(CalibrateNoise, AModelWithMoreLateralNoiseKeepsTheAxialOne) {
  const StructuredLightNoise truth{.offset = 0,
                                   .quadratic = 2e-3,
                                   .vertex = 0,
                                   .grazing = 0,
                                   .lateral_px = 0.5,
                                   .lateral_grazing_px = 0};
  json report;
  int cases = 0;
  expect_axial(calibrated(truth, StereoNoise{}, 1, &report), truth, cases);
  EXPECT_NEAR(report.at("sigma_lateral_px").get<double>(), 0.5, kClose);
  EXPECT_EQ(cases, 3);
}

TEST_F(CalibrateNoise, WhatDoesNotTellTheNoiseIsRefused) {
  simulate("scene.off", {0}, 29, "tof.toml", 1, "on", "few");
  simulate("scene.off", {0, 0.01}, 20, "tof.toml", 1, "on", "moving");
  simulate("wall.off", {0}, 30, "tof.toml", 1, "on", "flat");
  simulate("scene.off", {0}, 30, "tof.toml", 1, "off", "exact");
  const auto with = [](const std::string& frames) {
    return Strings{"calibrate", "--noise", frames, "--out", "new.toml"};
  };
  expect_refused(
      {{with("few"), "30 frames from one pose are required, not 29"},
       {with("moving"), "Does the scene or the camera move?"},
       {with("flat"), "the straight depth edges"},
       {with("exact"), "below their rounding step of 1e-04 m"},
       {{"calibrate", "flat", "--out", "new.toml"}, "give either --noise or --range"},
       {{"calibrate", "--noise", "flat", "--out", "new.txt"}, "must have the ending .toml"},
       {test::joined(with("flat"), {"--depth-scale", "0"}), "--depth-scale"},
       {with("nowhere"), "nowhere"}});
}

}  // namespace
}  // namespace viewgain
