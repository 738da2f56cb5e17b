// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A camera with a systematic error, simulated, is calibrated before a wall and read with the table.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

class Calibrate : public test::ProgramTest {
 protected:
  Calibrate() {
    write("wall.off", "OFF\n4 1 0\n-30 -30 0\n30 -30 0\n30 30 0\n-30 30 0\n4 0 1 2 3\n");
    write_half_sensor();
  }

  // Frames of the wall z = 0 from these distances along the optical axis, turned by `angle` to
  // either side in turns.
  void simulate(const std::string& out, const std::vector<double>& distances, double angle,
                const std::string& sensor) const {
    std::vector<Pose> poses;
    for (const double distance : distances) {
      const double turn = poses.size() % 2 == 0 ? angle : -angle;
      poses.emplace_back(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                         Eigen::Vector3d(0.1, 0.2, -distance * std::cos(turn)));
    }
    write_tum(dir / (out + ".txt"), poses);
    run_well({"simulate", "wall.off", "--poses", out + ".txt", "--sensor", sensor, "--background",
              "0", "--out", out});
  }

  // The readings of the frames are off by A sin(4 phase), as of a camera whose light is no sine.
  void spoil(const std::string& frames_dir, const std::string& sensor) const {
    FrameSequence frames = open_frames(dir / frames_dir);
    frames.out_of_range = Sensor::OutOfRange::invalid;
    const std::vector<Eigen::Vector3d> rays = frames.sensor.camera.ray_table();
    const double period = unambiguous_range(frames.sensor.noise);
    for (std::size_t f = 0; f < frames.images.size(); ++f) {
      const DepthFrame frame = load_frame(frames, f);
      GrayImage image{frame.width, frame.height, {}};
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const double range = frame.depth[i] * rays[i].norm();
        const double error = 0.01 * std::sin(8 * std::numbers::pi * range / period);
        const double depth = range > 0 ? (range + error) / rays[i].norm() : 0;
        image.pixels.push_back(static_cast<std::uint16_t>(std::lround(depth / 1e-4)));
      }
      write_png(frames.images[f], image);
    }
    write(frames_dir + "/sensor.toml", read(sensor));
  }

  // How far readings are off along their rays, RMS.
  [[nodiscard]] double off(const std::string& frames_dir, const std::string& sensor) const {
    FrameSequence frames = open_frames(dir / frames_dir, (dir / sensor).string());
    frames.out_of_range = Sensor::OutOfRange::invalid;
    const std::vector<Eigen::Vector3d> rays = frames.sensor.camera.ray_table();
    double squares = 0;
    int readings = 0;
    for (std::size_t f = 0; f < frames.images.size(); ++f) {
      const DepthFrame frame = load_frame(frames, f);
      const Pose& T_world_camera = frames.poses[f];
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const double along = (T_world_camera.rotation() * rays[i]).z();
        const double truth = -T_world_camera.translation().z() / along * rays[i].norm();
        if (!(along > 0 && truth < 5) || frame.depth[i] == 0) continue;
        squares += std::pow(frame.depth[i] * rays[i].norm() - truth, 2);
        ++readings;
      }
    }
    return std::sqrt(squares / readings);
  }
};

// The map is as of a camera without the error, and says of which sensor it is.
TEST_F(Calibrate, MapsAreMadeOfCorrectedReadings) {
  const std::vector<double> distances{0.6, 0.8, 1.0, 1.2};
  simulate("wall", distances, 0.6, "tof.toml");
  spoil("wall", "tof.toml");
  const json report = json::parse(
      run_well({"calibrate", "wall", "--wall", "0,0,1,0", "--out", "calibrated.toml", "--json"}));
  EXPECT_GT(report.at("rms_before").get<double>(), 3 * report.at("rms_after").get<double>());
  // A sensor that has a table is calibrated anew, by the same readings.
  run_well({"calibrate", "wall", "--wall", "0,0,1,0", "--sensor", "calibrated.toml", "--out",
            "again.toml"});
  EXPECT_EQ(read("again.toml"), read("calibrated.toml"));
  simulate("wrong", {0.87}, 0, "calibrated.toml");
  // Simulated readings have no such error, so the table does not go with them.
  EXPECT_EQ(read("wrong/sensor.toml").find("range_calibration"), std::string::npos);
  spoil("wrong", "calibrated.toml");
  EXPECT_GT(off("wrong", "tof.toml"), 0.005);
  EXPECT_LT(off("wrong", "wrong/sensor.toml"), 0.001);

  const Strings layout{"--voxel", "0.01", "--workspace", "-0.3,-0.3,-0.1,0.5,0.5,0.1"};
  run_well(test::joined({"integrate", "wrong", "--out", "map.vdb"}, layout));
  run_well({"integrate", "wrong", "--sensor", "calibrated.toml", "--map", "map.vdb", "--out",
            "map.vdb"});  // says nothing of another sensor
  const auto other = run({"score", "map.vdb", "--sensor", "tof.toml", "--sphere", "3,0.6"});
  EXPECT_EQ(other.exit_code, 0);
  EXPECT_NE(other.err.find("not from this tof"), std::string::npos) << other.err;
}

TEST_F(Calibrate, FramesMayBeLeftOutAndMaskedAndNeedNoPoses) {
  const std::vector<double> distances{0.6, 0.8, 1.0};
  simulate("wall", distances, 0.5, "tof.toml");
  std::filesystem::remove(dir / "wall/poses.txt");
  write("named.txt", "frame-000002 1.0\nframe-000000.depth.png 0.6\n");
  std::filesystem::create_directory(dir / "masks");
  Gray8Image mask{88, 72, std::vector<std::uint8_t>(88 * 72, 0)};
  std::fill_n(mask.pixels.begin(), 88 * 20, std::uint8_t{1});
  write_png(dir / "masks/frame-000002.depth.png", mask);
  const json report =
      json::parse(run_well({"calibrate", "wall", "--distances", "named.txt", "--depth-scale",
                            "1e-4", "--mask", "masks", "--out", "calibrated.toml", "--json"}));
  EXPECT_EQ(report.at("frames"), 2);
  EXPECT_EQ(report.at("dropped"), json({{"no_distance", 1}}));
  EXPECT_EQ(report.at("masked_pixels"), 88 * 20);
  const json& frame = report.at("per_frame")[1];
  EXPECT_EQ(frame.at("name"), "frame-000002.depth.png");
  std::uint64_t readings = 0;
  for (const char* key : {"readings", "border", "sparse", "limits", "off_wall"}) {
    readings += frame.at(key).get<std::uint64_t>();
  }
  EXPECT_EQ(readings, 88U * 52U);
  const std::string text = run_well({"calibrate", "wall", "--distances", "named.txt",
                                     "--depth-scale", "1e-4", "--out", "calibrated.toml"});
  for (const char* part : {"frame-000000.depth.png", "no_distance", "RMS", "calibrated.toml"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in " << text;
  }
}

TEST_F(Calibrate, WhatCannotBeIsRefusedInOneLine) {
  simulate("wall", {0.6, 0.8, 1.0}, 0.5, "tof.toml");
  write("good.txt", "0.6\n0.8\n1.0\n");
  write("few.txt", "0.6\n0.8\n");
  write("many.txt", "0.6\n0.8\n1.0\n1.2\n");
  write("word.txt", "0.6\nmetre\n1.0\n");
  write("negative.txt", "0.6\n-0.8\n1.0\n");
  write("unknown.txt", "frame-000007 0.6\n");
  write("twice.txt", "frame-000001 0.8\nframe-000001.depth.png 0.8\n");
  write("mixed.txt", "0.6\nframe-000001 0.8\n1.0\n");
  write("empty.txt", "# nothing\n");
  write("swapped.txt", "1.0\n0.8\n0.6\n");
  write("broken.toml",
        read("tof.toml") + "[range_calibration]\nmeasured = [1.0, 0.5]\nerror = [0.0, 0.0]\n");
  for (const auto& [name, bytes] : contents("wall")) write("damaged/" + name, bytes);
  write("damaged/frame-000001.depth.png", "no image");
  const auto with = [](const std::string& frames, const std::string& distances) {
    return Strings{"calibrate", frames, "--distances", distances, "--out", "new.toml"};
  };
  // An image that cannot be read costs its frame alone.
  const json left = json::parse(run_well(
      {"calibrate", "damaged", "--distances", "good.txt", "--out", "damaged.toml", "--json"}));
  EXPECT_EQ(left["dropped"], json({{"unreadable", 1}}));
  const auto before_wall = [](const std::string& wall) {
    return Strings{"calibrate", "wall", "--wall", wall, "--out", "new.toml"};
  };
  expect_refused(
      {{{"calibrate", "wall", "--out", "new.toml"}, "--distances or --wall"},
       {test::joined(with("wall", "good.txt"), {"--wall", "0,0,1,0"}), "--distances or --wall"},
       {with("wall", "few.txt"), "few.txt: has 2 distances for 3 frames"},
       {with("wall", "many.txt"), "many.txt:4: "},
       {with("wall", "word.txt"), "word.txt:2: "},
       {with("wall", "negative.txt"), "negative.txt:2: the distance -0.8"},
       {with("wall", "unknown.txt"), "unknown.txt:1: there is no frame"},
       {with("wall", "twice.txt"), "twice.txt:2: the frame has a distance"},
       {with("wall", "mixed.txt"), "mixed.txt:2: needs a distance"},
       {with("wall", "empty.txt"), "empty.txt: has 0 distances"},
       {with("wall", "none.txt"), "none.txt"},
       {with("wall", "swapped.txt"), "frame-000000.depth.png: reads the wall at"},
       {with("nowhere", "good.txt"), "nowhere"},
       {test::joined(with("wall", "good.txt"), {"--sensor", "broken.toml"}), "broken.toml: "},
       {test::joined(with("wall", "good.txt"), {"--mask", "wall"}), "frame-000000.depth.png"},
       {test::joined(with("wall", "good.txt"), {"--depth-scale", "0"}), "--depth-scale"},
       {before_wall("0,0,1"), "--wall"},
       {before_wall("0,0,0,1"), "--wall 0,0,0,1: the normal is zero"},
       {{"calibrate", "wall", "--wall", "0,0,1,0", "--out", "new.txt"}, "must end in .toml"},
       {{"calibrate", "wall", "--wall", "0,0,1,0", "--out", "wall/sensor.toml"}, "FRAMES_DIR"},
       {{"calibrate", "wall", "--distances", "good.txt", "--out", "good.txt"}, "--distances"},
       {{"integrate", "wall", "--sensor", "broken.toml", "--voxel", "0.05", "--out", "new.vdb"},
        "0.5 m follows 1 m"}});
}

// The noise with which a static scene was simulated is found in its frames. The sensor that the
// calibration begins with is wrong by a factor of two.

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

TEST_F(CalibrateNoise, ShotNoiseIsFound) {
  const NoiseModel truth = read_sensor_toml(dir / "tof.toml").noise;
  NoiseModel guess = truth;
  std::get<ShotNoise>(guess).reference_sigma *= 2;
  int cases = 0;
  for (const int seed : {1, 2, 3}) {
    json report;
    expect_axial(calibrated(truth, guess, seed, &report), truth, cases);
    EXPECT_FALSE(report.at("lateral_in_model").get<bool>());
    EXPECT_NEAR(report.at("sigma_lateral_px").get<double>(), 1, kClose);
    EXPECT_EQ(report.at("frames"), 40);
  }
  EXPECT_EQ(cases, 9);
}

TEST_F(CalibrateNoise, StructuredLightIsFoundWithItsGrowthAndAcrossTheRay) {
  const StructuredLightNoise truth;
  StructuredLightNoise guess = truth;
  guess.offset *= 2;
  guess.quadratic *= 0.5;
  guess.lateral_px = 0.4;
  int cases = 0;
  for (const int seed : {1, 2, 3}) {
    json report;
    const Sensor found = calibrated(truth, guess, seed, &report);
    expect_axial(found, truth, cases);
    EXPECT_TRUE(report.at("ranges_tell_shape").get<bool>());
    EXPECT_NEAR(std::get<StructuredLightNoise>(found.noise).lateral_px, truth.lateral_px,
                kClose * truth.lateral_px);
  }
  EXPECT_EQ(cases, 9);
}

TEST_F(CalibrateNoise, ConstantNoiseIsFoundInMetres) {
  const ConstantNoise truth{0.004, 0.008};
  int cases = 0;
  for (const int seed : {1, 2, 3}) {
    const Sensor found = calibrated(truth, ConstantNoise{0.002, 0.004}, seed);
    expect_axial(found, truth, cases);
    EXPECT_NEAR(std::get<ConstantNoise>(found.noise).sigma_lateral, truth.sigma_lateral,
                kClose * truth.sigma_lateral);
  }
  EXPECT_EQ(cases, 9);
}

TEST_F(CalibrateNoise, WhatDoesNotTellTheNoiseIsRefused) {
  simulate("scene.off", {0}, 29, "tof.toml", 1, "on", "few");
  simulate("scene.off", {0, 0.01}, 20, "tof.toml", 1, "on", "moving");
  simulate("wall.off", {0}, 30, "tof.toml", 1, "on", "flat");
  simulate("scene.off", {0}, 30, "tof.toml", 1, "off", "exact");
  const auto with = [](const std::string& frames) {
    return Strings{"calibrate", "--noise", frames, "--out", "new.toml"};
  };
  expect_refused({{with("few"), "needs 30 frames from one pose, not 29"},
                  {with("moving"), "the scene or the camera moves"},
                  {with("flat"), "too few jumps of depth"},
                  {with("exact"), "no more than their rounding to 1e-04 m"},
                  {test::joined(with("flat"), {"--wall", "0,0,1,1"}), "needs one of --noise"},
                  {test::joined(with("flat"), {"--mask", "flat"}), "--mask does not go"}});
}

}  // namespace
}  // namespace viewgain
