// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "apps/program_runner.hpp"
#include "core/comma_locale.hpp"
#include "core/expect_error.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

using test::expect_error;

class Files : public test::ProgramTest {
 protected:
  // Reading this sensor throws an Error with the word and the file's name.
  void expect_sensor_error(const std::string& text, const std::string& word) const {
    write("bad.toml", text);
    for (const std::string& part : {word, std::string("bad.toml")}) {
      expect_error(ErrorCode::format, part, [&] { (void)read_sensor_toml(dir / "bad.toml"); });
    }
  }
};

BeliefGrid octree_map() {
  GridConfig config;
  config.voxel_size = 0.05;
  config.workspace = {{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}};
  config.prior_sigma = 0.01;
  const std::vector<std::uint8_t> states(16 * 16 * 16, 2);
  return BeliefGrid::from_states(config, states);
}

bool equal(const Sensor& a, const Sensor& b) {
  return a.name == b.name && a.camera == b.camera && a.min_range == b.min_range &&
         a.max_range == b.max_range && a.working_distance == b.working_distance &&
         a.noise == b.noise && a.T_flange_camera == b.T_flange_camera &&
         a.body_size == b.body_size && a.range_calibration == b.range_calibration &&
         a.pose_sigma == b.pose_sigma && a.scale_sigma == b.scale_sigma;
}

TEST_F(Files, SensorsReadBackEqual) {
  int cases = 0;
  for (const std::string& name : sensor_preset_names()) {
    const Sensor sensor = sensor_preset(name);
    write("sensor.toml", sensor_toml(sensor));
    EXPECT_TRUE(equal(read_sensor_toml(dir / "sensor.toml"), sensor)) << sensor_toml(sensor);
    EXPECT_TRUE(equal(load_sensor(name), sensor));
    ++cases;
  }
  EXPECT_EQ(cases, 5);

  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.01, 1.0);
  for (int i = 0; i < 200; ++i) {
    Sensor sensor = sensor_preset("sr4000");
    sensor.name = "a \"name\" with \\ and \xc3\xa4 " + std::to_string(i);
    sensor.camera.fx = 100 * unit(random);
    sensor.camera.cy = std::ldexp(unit(random), i % 40 - 20);
    sensor.camera.distortion = {-unit(random), unit(random), 1e-5 * unit(random), 0, -1e-17};
    const NoiseModel models[]{ShotNoise{unit(random), 1, 2, 1e-3, 1e6 * unit(random), unit(random)},
                              StructuredLightNoise{}, StereoNoise{unit(random), 400, 0.1},
                              QuadraticNoise{unit(random), 3, i % 2 == 0 ? 0.0 : unit(random)},
                              ConstantNoise{unit(random), unit(random)}};
    sensor.noise = models[i % 5];
    sensor.T_flange_camera =
        look_at({unit(random), -unit(random), unit(random)}, {unit(random), 1.5, -unit(random)});
    if (i % 2 == 0) sensor.body_size = {unit(random), 0.1, 1e-3 * unit(random)};
    if (i % 3 == 0) sensor.pose_sigma = {unit(random), 1e-3 * unit(random)};
    if (i % 4 == 0) sensor.scale_sigma = 0.01 * unit(random);
    for (int k = 0; k < i % 30; ++k) {
      sensor.range_calibration.table.push_back({k + 1 + 0.1 * unit(random), unit(random) - 0.5});
    }
    write("sensor.toml", sensor_toml(sensor));
    EXPECT_TRUE(equal(read_sensor_toml(dir / "sensor.toml"), sensor)) << sensor_toml(sensor);
    ++cases;
  }
  EXPECT_EQ(cases, 205);
}

// The flag --register is in degrees; files of 0.1.0 have the key without its unit.
TEST_F(Files, TheSigmaOfPosesHasItsUnitInItsName) {
  Sensor sensor = sensor_preset("d435");
  sensor.pose_sigma = {0.004, 0.01};
  const std::string text = sensor_toml(sensor);
  EXPECT_NE(text.find("pose_sigma_rad = [0.004, 0.01]"), std::string::npos) << text;
  write("old.toml", test::with(text, "pose_sigma_rad", "pose_sigma"));
  EXPECT_TRUE(equal(read_sensor_toml(dir / "old.toml"), sensor));
}

TEST_F(Files, SensorsAreWrittenAlikeInEveryLocale) {
  Sensor sensor = sensor_preset("d435");
  sensor.camera.width = 1280;  // with a thousands separator, if one crept in
  sensor.camera.cx = 639.25;
  const std::string text = sensor_toml(sensor);
  const test::CommaLocale locale;
  EXPECT_EQ(sensor_toml(sensor), text);
  write("sensor.toml", text);
  EXPECT_TRUE(equal(read_sensor_toml(dir / "sensor.toml"), sensor)) << text;
}

TEST_F(Files, StereoWithoutAFocalLengthGoesByTheCameras) {
  Sensor sensor = sensor_preset("d435");
  StereoNoise noise;
  noise.focal = 0;
  sensor.noise = noise;
  const std::string text = sensor_toml(sensor);
  EXPECT_EQ(text.find("focal"), std::string::npos) << text;
  write("sensor.toml", text);
  const Sensor read = read_sensor_toml(dir / "sensor.toml");
  EXPECT_TRUE(equal(read, sensor)) << text;
  sensor.noise = StereoNoise{noise.subpixel, sensor.camera.fx, noise.baseline};
  EXPECT_EQ(read.sigmas(1.0).axial, sensor.sigmas(1.0).axial);
  expect_sensor_error(text + "focal = -1.0\n", "focal");
}

TEST_F(Files, MapsRememberTheirOrigin) {
  const std::set<std::string> frames{"0123456789abcdef frame-000000.depth.png",
                                     "fedcba9876543210 frame-000000.depth.png"};
  BeliefGrid map = octree_map();
  map.set_notes({.frames = frames});
  save_map(map, dir / "map.vdb");
  EXPECT_EQ(load_map(dir / "map.vdb").notes().frames, frames);
  EXPECT_FALSE(map_sensor(load_map(dir / "map.vdb")));
  Sensor sensor = sensor_preset("d435");
  sensor.out_of_range = Sensor::OutOfRange::invalid;
  map.set_notes({.sensor = sensor_toml(sensor)});
  save_map(map, dir / "map.vdb");
  EXPECT_TRUE(load_map(dir / "map.vdb").notes().frames.empty());
  EXPECT_EQ(map_sensor(load_map(dir / "map.vdb")), sensor);
  // Notes of another program's: in its words, or none.
  map.set_notes({.sensor = "# mine\n" + sensor_toml(sensor)});
  save_vdb(map, dir / "map.vdb");
  EXPECT_EQ(load_map(dir / "map.vdb").notes().sensor, sensor_toml(sensor));
  map.set_notes({.sensor = "name = 1\n"});
  save_vdb(map, dir / "bad.vdb");
  expect_error(ErrorCode::format, "bad.vdb: line 1: key \"name\"",
               [&] { (void)load_map(dir / "bad.vdb"); });
  EXPECT_THROW((void)frame_identity(FrameSequence{}, 0), Error);
}

TEST_F(Files, ATreeIsReadFromAPipeAsFromAFile) {
  write("tree.ot", octomap_bytes(octree_map()));
  const Sensor sensor = sensor_preset("sr4000");
  const BeliefGrid from_file = load_map(dir / "tree.ot", &sensor);
  const std::filesystem::path pipe = dir / "pipe.ot";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << read("tree.ot"); });
  std::optional<BeliefGrid> from_pipe;
  EXPECT_NO_THROW(from_pipe.emplace(load_map(pipe, &sensor)));
  writer.join();
  ASSERT_TRUE(from_pipe);
  EXPECT_EQ(from_pipe->content_hash(), from_file.content_hash());
  EXPECT_EQ(from_pipe->prior_sigma(), default_prior_sigma(0.05, sensor));
}

// Nobody has named them, so they are not waited for.
TEST_F(Files, PipesInAFolderOfFramesAreRefused) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 4, sensor.camera.height = 2;
  FramesWriter writer(dir / "frames");
  writer.write_frame(0, {4, 2, std::vector<float>(8, 0.5F)});
  writer.commit(std::vector<Pose>(1), sensor);
  for (const char* name : {"poses.txt", "sensor.toml"}) {
    const fs::path file = dir / "frames" / name, away = dir / "away";
    fs::rename(file, away);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    expect_error(ErrorCode::io, std::string(name) + ": cannot be read: it is not a regular file",
                 [&] { (void)open_frames(dir / "frames"); });
    fs::rename(away, file);
  }
  EXPECT_EQ(open_frames(dir / "frames").images.size(), 1U);
}

TEST_F(Files, SensorErrorsNameTheKey) {
  const std::string good = sensor_toml(sensor_preset("d435"));
  const auto with = [&good](const std::string& from, const std::string& to) {
    return test::with(good, from, to);
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {with("fx = 447.0", ""), "\"camera.fx\" is missing"},
      {with("fx = 447.0", "fx = \"447\""), "\"camera.fx\" must be a number"},
      {with("fx = 447.0", "fx = nan"), "\"camera.fx\" must be finite"},
      {with("width = 640", "width = 640.5"), "\"camera.width\" must be a whole number"},
      {with("width = 640", "width = 1e63"), "\"camera.width\" must be a whole number"},
      {with("width = 640", "width = -1"), "\"camera.width\""},
      {with("width = 640", "width = 0"), "width"},
      {with("distortion = [0.0, ", "distortion = ["), "\"camera.distortion\""},
      {with("min_range", "min_rang"), "\"min_range\" is missing"},
      {with("[camera]", "colour = 3\n[camera]"), "\"colour\" is unknown"},
      {with("[noise]", "[noise]\nsigma = 1"), "\"noise.sigma\" is unknown"},
      {with("\"stereo\"", "\"laser\""), "valid values: shot"},
      {with("baseline = 0.05", "baseline = -0.05"), "baseline"},
      {with("[camera]", "T_flange_camera = [[1,0,0,0],[0,1,0,0],[0,0,3,0],[0,0,0,1]]\n[camera]"),
       "\"T_flange_camera\" is not a rigid transform"},
      {with("[camera]", "T_flange_camera = [1, 2]\n[camera]"), "\"T_flange_camera\""},
      {with("body = [0.09", "body = [-0.09"), "body_size must be positive"},
      {with("body = [0.09, ", "body = ["), "\"body\""},
      {with("[camera]", "[camera"), "line "},
      {"pose_sigma = 0.005\n" + good, "pose_sigma"},
      {"pose_sigma = [0.1, 0.1]\npose_sigma_rad = [0.1, 0.1]\n" + good, "pose_sigma_rad"},
      {"pose_sigma = [0.005, -0.1]\n" + good, "pose_sigma"},
      {"pose_sigma = [0.1, 0.1, 0.1]\n" + good, "pose_sigma"},
      {"scale_sigma = -0.005\n" + good, "scale_sigma"},
      {"scale_sigma = [0.005]\n" + good, "scale_sigma"},
      {"", "\"name\" is missing"},
      {good + "[range_calibration]\nerror = [0.01]\n", "\"range_calibration.measured\" is missing"},
      {good + "[range_calibration]\nmeasured = [1.0, 2.0]\nerror = [0.01]\n",
       "\"range_calibration.error\" must be a list of 2 numbers"},
      {good + "[range_calibration]\nmeasured = []\nerror = []\n", "measured\" must be a list"},
      {good + "[range_calibration]\nmeasured = 1.0\nerror = 0.0\n", "measured\" must be a list"},
      {good + "[range_calibration]\nmeasured = [1.0, nan]\nerror = [0.0, 0.0]\n", "finite"},
      {good + "[range_calibration]\nmeasured = [2.0, 1.5]\nerror = [0.0, 0.0]\n", "1.5 m follows"},
      {good + "[range_calibration]\nmeasured = [2.0]\nerror = [12.5]\n",
       "12.5 m is not a valid range"},
      {good + "[range_calibration]\nmeasured = [2.0]\nerrors = [0.0]\n", "error\" is missing"},
      {good + "[range_calibration]\nmeasured = [2.0]\nerror = [0.0]\nunit = 1\n",
       "\"range_calibration.unit\" is unknown"},
      {with("[camera]", "range_calibration = 3\n[camera]"),
       "\"range_calibration\" must be a table"}};
  for (const auto& [text, wanted] : cases) expect_sensor_error(text, wanted);
  EXPECT_THROW((void)load_sensor("none.toml"), Error);
  EXPECT_THROW((void)load_sensor("sr5000"), Error);
}

TEST_F(Files, GrayImagesReadBack) {
  GrayImage image{37, 23, {}};
  std::mt19937 random(5);
  for (int i = 0; i < 37 * 23; ++i) image.pixels.push_back(static_cast<std::uint16_t>(random()));
  image.pixels[0] = 0;
  image.pixels[1] = 65535;
  image.pixels[2] = 0x1234;
  write_png(dir / "a.png", image);
  EXPECT_EQ(read_gray_png(dir / "a.png", 37, 23).pixels, image.pixels);
  EXPECT_THROW((void)read_gray_png(dir / "a.png", 23, 37), Error);

  write_png(dir / "rgb.png", RgbImage{4, 2, std::vector<std::uint8_t>(24, 9)});
  EXPECT_THROW((void)read_gray_png(dir / "rgb.png", 4, 2), Error);
  EXPECT_THROW((void)read_gray_png(dir / "none.png", 4, 2), Error);
}

TEST_F(Files, FramesReadBackInTenthsOfAMillimetre) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 4;
  sensor.camera.height = 2;
  const DepthFrame frame{
      4,
      2,
      {std::nanf(""), DepthFrame::kOutOfRange, 0.12344F, 0.12346F, 6.5534F, 6.5536F, 1e-5F, -1.0F}};
  const std::vector<Pose> poses{look_at({1, 0, 0}, {0, 0, 0}), look_at({0, 1, 0}, {0, 0, 0})};
  {
    FramesWriter writer(dir / "frames");
    writer.write_frame(0, frame);
    writer.write_frame(1, frame);
    EXPECT_FALSE(std::filesystem::exists(dir / "frames"));
    writer.commit(poses, sensor);
  }
  EXPECT_EQ(list("frames"),
            (std::vector<std::string>{"frame-000000.depth.png", "frame-000001.depth.png",
                                      "frames.toml", "poses.txt", "sensor.toml", "simulated.txt"}));
  FrameSequence frames = open_frames(dir / "frames", "", std::nullopt);
  EXPECT_TRUE(equal(frames.sensor, sensor));
  EXPECT_EQ(frames.depth_scale, 1e-4);
  ASSERT_EQ(frames.poses.size(), 2U);
  const std::vector<float> expected{0.0F,    DepthFrame::kOutOfRange, 0.1234F, 0.1235F,
                                    6.5534F, DepthFrame::kInvalid,    0.0F,    0.0F};
  EXPECT_EQ(load_frame(frames, 1).depth, expected);
  frames.out_of_range = Sensor::OutOfRange::invalid;
  const DepthFrame read_back = load_frame(frames, 1);
  EXPECT_EQ(read_back.depth[1], DepthFrame::kInvalid);

  // Whose word counts: the folder's, else the sensor's, else the layout's, which is said.
  using Meaning = Sensor::OutOfRange;
  const auto expect = [&](Meaning meaning, bool is_assumed) {
    const FrameSequence opened = open_frames(dir / "frames");
    EXPECT_EQ(opened.out_of_range, meaning);
    EXPECT_EQ(opened.is_out_of_range_assumed, is_assumed);
    EXPECT_EQ(opened.depth_scale, opened.recorded ? 1e-3 : 1e-4);
  };
  sensor.out_of_range = Meaning::invalid;
  write_sensor_toml(dir / "frames/sensor.toml", sensor);
  expect(Meaning::carve, false);
  fs::remove(dir / "frames/frames.toml");  // as version 0.1.0 wrote it
  expect(Meaning::invalid, false);
  sensor.out_of_range.reset();
  write_sensor_toml(dir / "frames/sensor.toml", sensor);
  expect(Meaning::carve, false);
  EXPECT_EQ(assumed_text(open_frames(dir / "frames")), "");
  fs::remove(dir / "frames/simulated.txt");  // whoever wrote it
  expect(Meaning::carve, true);
  const std::string said = assumed_text(open_frames(dir / "frames"));
  for (const char* part : {"depth_scale = 1e-04", "out_of_range = \"carve\"", "frames.toml"}) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  }
  fs::rename(dir / "frames/poses.txt", dir / "frames/none.txt");
  expect(Meaning::invalid, false);
  fs::rename(dir / "frames/none.txt", dir / "frames/poses.txt");
}

// The same camera has the same scale, whether its file is in the folder or named.
TEST_F(Files, TheScaleDoesNotDependOnWhereTheSensorIs) {
  Sensor sensor = sensor_preset("kinect_v1");
  sensor.camera.width = 4, sensor.camera.height = 2;
  write_sensor_toml(dir / "mine.toml", sensor);
  write("frames/poses.txt", "0 0 0 0 0 0 0 1\n");
  write_png(dir / "frames/frame-000000.depth.png",
            GrayImage{4, 2, std::vector<std::uint16_t>(8, 9000)});
  const std::string mine = (dir / "mine.toml").string();
  const auto both = [&] {
    fs::remove(dir / "frames/sensor.toml");
    const FrameSequence named = open_frames(dir / "frames", mine);
    fs::copy(mine, dir / "frames/sensor.toml");
    const FrameSequence own = open_frames(dir / "frames");
    EXPECT_EQ(named.depth_scale, own.depth_scale);
    EXPECT_EQ(named.out_of_range, own.out_of_range);
    EXPECT_EQ(assumed_text(named), assumed_text(own));
    EXPECT_EQ(load_frame(named, 0), load_frame(own, 0));
    return own;
  };
  EXPECT_NE(assumed_text(both()), "");
  write("frames/frames.toml", "depth_scale = 1e-3\nout_of_range = \"invalid\"\n");
  FrameSequence frames = both();
  EXPECT_EQ(frames.depth_scale, 1e-3);
  EXPECT_EQ(frames.out_of_range, Sensor::OutOfRange::invalid);
  EXPECT_EQ(assumed_text(frames), "");
  write("frames/frame-000000.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 9\n0 0 0 1\n");
  write("frames/frames.toml", "poses = \"frame-NNNNNN.pose.txt\"\n");
  EXPECT_EQ(both().poses[0].translation().z(), 9);
  for (const auto& [text, word] :
       {std::pair{"depth_scale = -1", "depth_scale"},
        std::pair{"out_of_range = \"far\"", "out_of_range"},
        std::pair{"poses = \"mine.txt\"", "poses"}, std::pair{"first_frame = -1", "first_frame"},
        std::pair{"first_frame = 1.5", "first_frame"}, std::pair{"scale = 1", "scale"},
        std::pair{"x", "frames.toml"}}) {
    write("frames/frames.toml", text);
    expect_error(ErrorCode::format, word, [&] { (void)open_frames(dir / "frames"); });
  }
}

// A surface that is only too far for the file is no free space.
TEST_F(Files, ImagesHoldWhatTheSensorSees) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 2, sensor.camera.height = 1;
  std::size_t cases = 0;
  for (const auto& [range, scale] :
       {std::pair{5.0, 1e-4}, std::pair{6.5534, 1e-4}, std::pair{6.6, 2e-4}, std::pair{20.0, 5e-4},
        std::pair{65.0, 1e-3}, std::pair{1000.0, 2e-2}, std::pair{1e6, 1.0}}) {
    sensor.max_range = range;
    EXPECT_EQ(depth_scale_for(sensor), scale) << range;
    const fs::path folder = dir / std::to_string(cases);
    const double depth = std::min(range, 65534 * scale);
    FramesWriter writer(folder, depth_scale_for(sensor));
    writer.write_frame(0, {2, 1, {static_cast<float>(depth), static_cast<float>(2 * range)}});
    writer.commit(std::vector<Pose>(1), sensor);
    const FrameSequence frames = open_frames(folder);
    EXPECT_EQ(frames.depth_scale, scale);
    const DepthFrame read = load_frame(frames, 0);
    EXPECT_NEAR(read.depth[0], depth, 0.51 * scale) << range;
    EXPECT_NE(read.depth[1], DepthFrame::kOutOfRange) << range;
    ++cases;
  }
  EXPECT_EQ(cases, 7U);
  for (const double scale : {0.0, -1.0, 2.0, std::nan("")}) {
    expect_error(ErrorCode::invalid_argument, "depth scale",
                 [&] { const FramesWriter writer(dir / "none", scale); });
  }
}

// Line i is the image of number i, of however many digits; two images of a number are refused.
TEST_F(Files, FramesHaveNumbersOfAnyLength) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 4, sensor.camera.height = 2;
  const DepthFrame frame{4, 2, std::vector<float>(8, 0.5F)};
  FramesWriter writer(dir / "frames");
  for (std::size_t i = 0; i < 3; ++i) writer.write_frame(i, frame);
  writer.commit(std::vector<Pose>(3), sensor);
  const fs::path folder = dir / "frames";
  fs::rename(folder / "frame-000001.depth.png", folder / "frame-1.depth.png");
  fs::rename(folder / "frame-000002.depth.png", folder / "frame-0000002.depth.png");
  const FrameSequence frames = open_frames(folder);
  ASSERT_EQ(frames.images.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read_frame(frames, i).fault.verdict, FrameVerdict::used) << frames.images[i];
  }
  // As of clocks in nanoseconds. Only where it is said can an image be without a line.
  write("frames/frames.toml", "depth_scale = 1e-4\nfirst_frame = 0\n");
  for (const char* number : {"1700000000123456789", "18446744073709551615"}) {
    const fs::path late = folder / ("frame-" + std::string(number) + ".depth.png");
    fs::copy(folder / "frame-1.depth.png", late);
    EXPECT_EQ(open_frames(folder).images.back(), late);
    fs::remove(late);
  }
  const fs::path beyond = folder / "frame-18446744073709551616.depth.png";
  fs::copy(folder / "frame-1.depth.png", beyond);
  expect_error(ErrorCode::format, "frame-18446744073709551616 has a number of more than 64 bits",
               [&] { (void)open_frames(folder); });
  fs::remove(beyond);
  fs::copy(folder / "frame-1.depth.png", folder / "frame-01.depth.png");
  expect_error(ErrorCode::format, "have the same number", [&] { (void)open_frames(folder); });
}

TEST_F(Files, AmplitudesReadBackInThousandths) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.width = 4;
  sensor.camera.height = 2;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const DepthFrame frame{4,
                         2,
                         std::vector<float>(8, 0.5F),
                         {0.0F, 0.0104F, 0.0106F, 65.535F, 70.0F, -1.0F, nan, 1.0F}};
  DepthFrame without = frame;
  without.amplitude.clear();
  const std::vector<Pose> poses{look_at({1, 0, 0}, {0, 0, 0}), look_at({0, 1, 0}, {0, 0, 0})};
  {
    FramesWriter writer(dir / "frames");
    writer.write_frame(0, frame);
    writer.write_frame(1, without);
    writer.commit(poses, sensor);
  }
  EXPECT_EQ(list("frames"),
            (std::vector<std::string>{"frame-000000.amplitude.png", "frame-000000.depth.png",
                                      "frame-000001.depth.png", "frames.toml", "poses.txt",
                                      "sensor.toml", "simulated.txt"}));
  const FrameSequence frames = open_frames(dir / "frames", "", std::nullopt);
  const std::vector<float> expected{
      0.0F, 0.010F, 0.011F, DepthFrame::kSaturated, DepthFrame::kSaturated, 0.0F, 0.0F, 1.0F};
  EXPECT_EQ(load_frame(frames, 0).amplitude, expected);
  EXPECT_TRUE(load_frame(frames, 1).amplitude.empty());
}

}  // namespace
}  // namespace viewgain
