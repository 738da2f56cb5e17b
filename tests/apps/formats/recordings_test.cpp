// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain import`, and the library behind it, on small recordings that the tests write in each
// format from poses and depths that they know.
#include "viewgain/formats/recordings.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "apps/program/commands/pose_file_text.hpp"
#include "apps/program_runner.hpp"
#include "program/cli/json.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/masks.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr int kWidth = 48, kHeight = 36;
constexpr std::size_t kFrames = 5;

Pose pose_of(std::size_t i) {
  const double a = 0.4 * static_cast<double>(i);
  return look_at({std::cos(a), std::sin(a), 0.3 + 0.1 * a}, {0.02, -0.01, 0.05 * a});
}

GrayImage image_of(std::size_t i, int width = kWidth, int height = kHeight) {
  GrayImage image{width, height, {}};
  for (int k = 0; k < width * height; ++k) {
    image.pixels.push_back(static_cast<std::uint16_t>(2000 + 3 * k + 100 * static_cast<int>(i)));
  }
  image.pixels[5] = 0;
  image.pixels[7] = 65535;
  return image;
}

// What load_depth() makes of it.
GrayImage without_saturated(GrayImage image) {
  std::replace(image.pixels.begin(), image.pixels.end(), std::uint16_t{65535}, std::uint16_t{0});
  return image;
}

// Its rotation scaled by this much: off by about twice that.
Pose off_by(Pose pose, double share) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 3; ++k) pose.m[4 * row + k] *= 1 + share;
  }
  return pose;
}

double difference(const Pose& a, const Pose& b) {
  double most = 0;
  for (std::size_t i = 0; i < 12; ++i) most = std::max(most, std::abs(a.m[i] - b.m[i]));
  return most;
}

struct Damage {
  std::string file;   // of the recording
  std::string bytes;  // instead of its own
  std::string word;   // that the message must have, besides the file's name
  bool missing = false;
};

class Recordings : public test::ProgramTest {
 protected:
  Recordings() { write_small_sensor(); }

  void write_image(const std::string& name, const GrayImage& image) const {
    fs::create_directories((dir / name).parent_path());
    write_png(dir / name, image);
  }

  // Frame i at time 100 + i / 30, its pose 4 ms later; poses in between belong to nobody.
  void write_tum_recording() const {
    std::string list = "# depth maps\n# timestamp filename\n";
    std::vector<Pose> poses;
    std::vector<double> times;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const double time = 100 + static_cast<double>(i) / 30;
      const std::string image = "depth/" + std::to_string(i) + ".png";
      write_image("rec/" + image, image_of(i));
      list += exact_text(time) + " " + image + "\n";
      poses.push_back(look_at({9, 9, 9}, {0, 0, 0}));
      times.push_back(time - 0.012);
      poses.push_back(pose_of(i));
      times.push_back(time + 0.004);
    }
    write("rec/depth.txt", list);
    viewgain::write_tum(dir / "rec/groundtruth.txt", poses, times);
  }

  // Frames 0, 10, 20, ...
  void write_bop_recording(double depth_scale = 0.1) const {
    json cameras;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const std::string number = std::to_string(10 * i);
      write_image("rec/depth/" + std::string(6 - number.size(), '0') + number + ".png",
                  image_of(i));
      const Pose T_camera_world = pose_of(i).inverse();
      const auto& m = T_camera_world.m;
      cameras[number] = {{"cam_K", {60.0, 0.0, 23.5, 0.0, 61.0, 17.5, 0.0, 0.0, 1.0}},
                         {"depth_scale", depth_scale},
                         {"cam_R_w2c", {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}},
                         {"cam_t_w2c", {1e3 * m[3], 1e3 * m[7], 1e3 * m[11]}}};
    }
    write("rec/scene_camera.json", cameras.dump());
  }
  [[nodiscard]] json bop_cameras() const { return json::parse(read("rec/scene_camera.json")); }

  void write_scannet_recording() const {
    for (std::size_t i = 0; i < kFrames; ++i) {
      write_image("rec/depth/" + std::to_string(i) + ".png", image_of(i));
      write("rec/pose/" + std::to_string(i) + ".txt", test::matrix_text(pose_of(i)));
    }
    write("rec/intrinsic/intrinsic_depth.txt", "60 0 23.5 0\n0 61 17.5 0\n0 0 1 0\n0 0 0 1\n");
  }

  // As published the camera's frame has y up, the images the upper row first.
  void write_icl_recording() const {
    std::vector<Pose> poses;
    std::vector<double> numbers;
    for (std::size_t i = 0; i < kFrames; ++i) {
      write_image("rec/depth/" + std::to_string(i) + ".png", image_of(i));
      poses.push_back(pose_of(i));
      numbers.push_back(static_cast<double>(i));
    }
    viewgain::write_tum(dir / "rec/traj0.gt.freiburg", poses, numbers);
    write("rec/associations.txt", "0 depth/0.png 0 rgb/0.png\n");
  }

  static Strings call(const std::string& format, const Strings& more = {}) {
    return test::joined({"import", "rec", "--format", format, "--out", "frames"}, more);
  }
  [[nodiscard]] json import_json(const std::string& format, Strings more = {}) const {
    more.emplace_back("--json");
    return json::parse(run_well(call(format, more)));
  }

  [[nodiscard]] std::string small_sensor() const { return (dir / "small.toml").string(); }

  // The folder has every frame, to the bit but for what inverting a pose costs.
  void expect_frames(double scale, const std::vector<std::size_t>& numbers, double tolerance,
                     bool with_own_sensor = false) const {
    const FrameSequence frames =
        open_frames(dir / "frames", with_own_sensor ? std::string() : small_sensor());
    EXPECT_EQ(frames.depth_scale, scale);
    ASSERT_EQ(frames.images.size(), numbers.size());
    EXPECT_EQ(frames.orthonormalized, 0U);
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::string number = std::to_string(numbers[i]);
      EXPECT_EQ(frames.images[i].filename(),
                "frame-" + std::string(6 - number.size(), '0') + number + ".depth.png");
      EXPECT_LE(difference(frames.poses[i], pose_of(i)), tolerance) << i;
      const DepthFrame frame = load_frame(frames, i);
      const GrayImage image = without_saturated(image_of(i));
      for (std::size_t k = 0; k < image.pixels.size(); ++k, ++pixels) {
        ASSERT_EQ(frame.depth[k], static_cast<float>(image.pixels[k] * scale)) << i << ' ' << k;
      }
    }
    EXPECT_EQ(pixels, numbers.size() * kWidth * kHeight);
  }

  // Each damage alone: exit code 2, one line that names the file, nothing made.
  template <typename Remake>
  void expect_damage_named(const Remake& remake, const Strings& arguments,
                           const std::vector<Damage>& damages) const {
    for (const Damage& damage : damages) {
      fs::remove_all(dir / "rec");
      remake();
      if (damage.missing) {
        ASSERT_TRUE(fs::remove(dir / "rec" / damage.file)) << damage.file;
      } else {
        write("rec/" + damage.file, damage.bytes);
      }
      const Strings before = list();
      const test::ProgramResult result = run(arguments);
      const std::string shown = damage.file + " <- " + damage.bytes.substr(0, 60);
      EXPECT_EQ(result.exit_code, 2) << shown << "\n" << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      EXPECT_NE(result.err.find(damage.file), std::string::npos) << shown << "\n" << result.err;
      EXPECT_NE(result.err.find(damage.word), std::string::npos) << shown << "\n" << result.err;
      EXPECT_EQ(result.out, "") << shown;
      EXPECT_EQ(list(), before) << shown;
    }
  }
  [[nodiscard]] std::string bytes_of(const GrayImage& image) const {
    write_image("image.png", image);
    const std::string bytes = read("image.png");
    fs::remove(dir / "image.png");
    return bytes;
  }
  [[nodiscard]] std::string cut_png() const { return bytes_of(image_of(0)).substr(0, 200); }
};

// A recording may be of anybody: what it links to elsewhere is none of its frames.
TEST_F(Recordings, LinksOutOfARecordingAreRefused) {
  write_bop_recording();
  run_well({"import", "rec", "--format", "bop", "--out", "good"});
  fs::create_directory_symlink("depth", dir / "rec/again");  // within
  run_well({"import", "rec", "--format", "bop", "--out", "good"});
  write_image("elsewhere/0.png", image_of(0));
  std::size_t cases = 0;
  for (const auto& [link, to] :
       {std::pair{"rec/depth/999999.png", dir / "elsewhere/0.png"},
        std::pair{"rec/depth/999999.png", fs::path("../../elsewhere/0.png")},
        std::pair{"rec/more", dir / "elsewhere"}, std::pair{"rec/gone", fs::path("/no/such")}}) {
    fs::create_symlink(to, dir / link);
    expect_refused({"import", "rec", "--format", "bop", "--out", "frames"},
                   std::string(link) + ": is a link out of the recording");
    fs::remove(dir / link);
    ++cases;
  }
  EXPECT_EQ(cases, 4U);
}

TEST_F(Recordings, TumComesThroughExactly) {
  write_tum_recording();
  const json result = import_json("tum", {"--intrinsics", "60,61,23.5,17.5"});
  EXPECT_EQ(result["frames"], kFrames);
  EXPECT_TRUE(result["dropped"].empty());
  EXPECT_EQ(result["intrinsics"], (json{60, 61, 23.5, 17.5}));
  EXPECT_EQ(result["readings"], kFrames * (kWidth * kHeight - 2));
  EXPECT_FALSE(result["rows_reversed"]);
  EXPECT_TRUE(result["sensor"].is_null());
  expect_frames(1.0 / 5000, {0, 1, 2, 3, 4}, 1e-14);
  // To the bit what the file's quaternions say.
  const PoseList said = read_tum(dir / "rec/groundtruth.txt");
  const FrameSequence frames = open_frames(dir / "frames", small_sensor());
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(frames.poses[i].m, said.poses[2 * i + 1].m) << i;
  }
  EXPECT_EQ(frames.sensor.camera.fy, 61);  // camera-intrinsics.txt
  // By a sensor: intrinsics, noise and ranges.
  const json with_sensor = import_json("tum", {"--sensor", "small.toml"});
  EXPECT_EQ(with_sensor["sensor"], "small");
  EXPECT_EQ(with_sensor["intrinsics"], (json{60, 60, 23.5, 17.5}));
  expect_frames(1.0 / 5000, {0, 1, 2, 3, 4}, 1e-14, true);
}

TEST_F(Recordings, BopComesThroughExactly) {
  write_bop_recording();
  const json result = import_json("bop");
  EXPECT_EQ(result["frames"], kFrames);
  EXPECT_EQ(result["depth_scale"], 0.1 * 1e-3);
  expect_frames(0.1 * 1e-3, {0, 10, 20, 30, 40}, 1e-14);
  EXPECT_EQ(open_frames(dir / "frames", small_sensor()).sensor.camera.fy, 61);
}

TEST_F(Recordings, ScanNetComesThroughExactly) {
  write_scannet_recording();
  EXPECT_EQ(import_json("scannet", {"--sensor", "small.toml"})["frames"], kFrames);
  expect_frames(1e-3, {0, 1, 2, 3, 4}, 0, true);
  EXPECT_EQ(open_frames(dir / "frames").sensor.camera.fy, 61);  // its own
}

// Row for row the other way up, each pixel is of the same point of the world.
TEST_F(Recordings, IclNuimIsTurnedSoThatItsPosesFit) {
  write_icl_recording();
  constexpr double kFx = 60, kFy = -58, kCx = 23, kCy = 16.25;
  const json result = import_json("icl-nuim", {"--intrinsics", "60,-58,23,16.25"});
  EXPECT_TRUE(result["rows_reversed"]);
  EXPECT_EQ(result["intrinsics"], (json{60, 58, 23, kHeight - 1 - kCy}));
  const FrameSequence frames = open_frames(dir / "frames", small_sensor());
  ASSERT_EQ(frames.images.size(), kFrames);
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const DepthFrame frame = load_frame(frames, i);
    const GrayImage image = image_of(i);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const auto k = static_cast<std::size_t>(v * kWidth + u);
        if (k == 5 || k == 7) continue;
        const double z = image.pixels[k] / 5000.0;
        const Eigen::Vector3d was(z * (u - kCx) / kFx, z * (v - kCy) / kFy, z);
        const int row = kHeight - 1 - v;
        const Eigen::Vector3d is = frame.at(u, row) * frames.sensor.camera.ray(u, row);
        ASSERT_LT((frames.poses[i] * is - pose_of(i) * was).norm(), 1e-6) << u << ' ' << v;
        ++pixels;
      }
    }
  }
  EXPECT_EQ(pixels, kFrames * (kWidth * kHeight - 2));
  EXPECT_NE(run_well(call("icl-nuim")).find("reversed"), std::string::npos);  // as published
  // A camera with y down is taken as it is.
  EXPECT_FALSE(import_json("icl-nuim", {"--intrinsics", "60,60,23.5,17.5"})["rows_reversed"]);
  expect_frames(1.0 / 5000, {0, 1, 2, 3, 4}, 1e-14);
}

TEST_F(Recordings, WhatCannotBeUsedIsDroppedAndCounted) {
  write_tum_recording();
  write("rec/depth.txt", read("rec/depth.txt") + "90 depth/none.png\n200.5 depth/none.png\n");
  write_image("rec/depth/3.png", image_of(3, 40, 30));
  const Strings intrinsics{"--intrinsics", "60,60,23.5,17.5"};
  json result = import_json("tum", intrinsics);
  EXPECT_EQ(result["dropped"], (json{{"no_pose", 2}, {"wrong_size", 1}}));
  EXPECT_EQ(result["frames"], kFrames - 1);
  EXPECT_FALSE(fs::exists(dir / "frames/frame-000003.depth.png"));
  // Within 4.1 ms each has its pose, within 3.9 ms none.
  Strings with_gap = intrinsics;
  with_gap.insert(with_gap.end(), {"--max-time-gap", "0.0041"});
  EXPECT_EQ(import_json("tum", with_gap)["frames"], kFrames - 1);
  with_gap.back() = "0.0039";
  expect_refused(call("tum", with_gap), "7 no_pose");
  const std::string text = run_well(call("tum", intrinsics));
  EXPECT_NE(text.find("left out: 2 no_pose, 1 wrong_size"), std::string::npos) << text;

  fs::remove_all(dir / "rec");
  write_bop_recording();
  json cameras = bop_cameras();
  cameras["0"].erase("cam_R_w2c");
  cameras.erase("10");
  cameras["30"]["depth_scale"] = 1.0;
  cameras["40"]["cam_K"][0] = 70.0;
  write("rec/scene_camera.json", cameras.dump());
  result = import_json("bop");
  EXPECT_EQ(result["dropped"], (json{{"depth_scale", 1}, {"intrinsics", 1}, {"no_pose", 2}}));
  EXPECT_EQ(result["frames"], 1);

  fs::remove_all(dir / "rec");
  write_scannet_recording();
  std::string lost;
  for (int i = 0; i < 4; ++i) lost += "-inf -inf -inf -inf\n";
  write("rec/pose/1.txt", lost);
  write("rec/pose/4.txt", lost);
  fs::remove(dir / "rec/pose/2.txt");
  result = import_json("scannet");
  EXPECT_EQ(result["dropped"], (json{{"lost_pose", 2}, {"no_pose", 1}}));
  EXPECT_EQ(result["frames"], 2);

  fs::remove_all(dir / "rec");
  write_icl_recording();
  write_image("rec/depth/77.png", image_of(0));
  EXPECT_EQ(import_json("icl-nuim", intrinsics)["dropped"], (json{{"no_pose", 1}}));
}

TEST_F(Recordings, OneDamagedPoseOrImageIsOneFrameLess) {
  write_scannet_recording();
  const std::string pose = read("rec/pose/3.txt"), image = read("rec/depth/1.png");
  const auto expect_dropped = [&](const json& dropped) {
    const json result = import_json("scannet");
    EXPECT_EQ(result["dropped"], dropped);
    EXPECT_EQ(result["frames"], kFrames - 1);
  };
  for (const char* lost :
       {"1 0 0 0\n0 1 0 0\n", "1 0 0 0\n0 1 0 0\n0 0 2 0\n0 0 0 1\n", "lost\n"}) {
    write("rec/pose/3.txt", lost);
    expect_dropped({{"lost_pose", 1}});
  }
  write("rec/pose/3.txt", pose);
  for (const std::string& damaged : {std::string("no picture"), std::string(), cut_png()}) {
    write("rec/depth/1.png", damaged);
    expect_dropped({{"unreadable", 1}});
  }
}

TEST_F(Recordings, RotationsThatAreOffAreMendedAndCounted) {
  write_scannet_recording();
  write("rec/pose/2.txt", test::matrix_text(off_by(pose_of(2), 2e-3)));
  EXPECT_EQ(import_json("scannet")["orthonormalized_poses"], 1);
  expect_frames(1e-3, {0, 1, 2, 3, 4}, 1e-12);

  fs::remove_all(dir / "rec");
  write_bop_recording();
  json cameras = bop_cameras();
  for (auto& value : cameras["20"]["cam_R_w2c"]) value = 1.002 * value.get<double>();
  write("rec/scene_camera.json", cameras.dump());
  EXPECT_EQ(import_json("bop")["orthonormalized_poses"], 1);
  expect_frames(0.1 * 1e-3, {0, 10, 20, 30, 40}, 1e-12);

  // Of the frames that are taken: a pose that belongs to nobody does not count.
  fs::remove_all(dir / "rec");
  write_tum_recording();
  write("rec/groundtruth.txt", read("rec/groundtruth.txt") + "300 0 0 0 0 0 0 1.001\n");
  EXPECT_EQ(import_json("tum", {"--sensor", "small.toml"})["orthonormalized_poses"], 0);
  const std::string list = "1 depth/0.png\n2 depth/1.png\n";
  write("rec/depth.txt", list);
  write("rec/groundtruth.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1.001\n");
  EXPECT_EQ(import_json("tum", {"--sensor", "small.toml"})["orthonormalized_poses"], 1);
  fs::rename(dir / "rec/groundtruth.txt", dir / "rec/a.gt.freiburg");
  EXPECT_EQ(import_json("icl-nuim")["orthonormalized_poses"], 1);
}

TEST_F(Recordings, AmplitudesComeWithTheFrames) {
  write_scannet_recording();
  GrayImage amplitude{kWidth, kHeight, std::vector<std::uint16_t>(kWidth * kHeight, 3)};
  amplitude.pixels[7] = 40'000;
  fs::create_directories(dir / "light");
  write_png(dir / "light/1.png", amplitude);
  json result = import_json("scannet", {"--amplitude", "light"});
  EXPECT_EQ(result["amplitudes"], 1);
  DepthFrame with = load_frame(open_frames(dir / "frames", small_sensor()), 1);
  ASSERT_EQ(with.amplitude.size(), amplitude.pixels.size());
  EXPECT_EQ(with.amplitude[6], 0.003F);
  EXPECT_EQ(with.amplitude[7], 40.0F);
  EXPECT_TRUE(load_frame(open_frames(dir / "frames", small_sensor()), 0).amplitude.empty());

  // Rounded to the folder's own units, at most what 16 bits hold.
  result = import_json("scannet", {"--amplitude", "light", "--amplitude-scale", "0.0025"});
  with = load_frame(open_frames(dir / "frames", small_sensor()), 1);
  EXPECT_EQ(with.amplitude[6], 0.008F);
  EXPECT_EQ(with.amplitude[7], 65.535F);

  // As the recording's images lie.
  fs::remove_all(dir / "rec");
  write_icl_recording();
  (void)import_json("icl-nuim", {"--amplitude", "light"});
  with = load_frame(open_frames(dir / "frames", small_sensor()), 1);
  EXPECT_EQ(with.amplitude[7], 0.003F);
  EXPECT_EQ(with.amplitude[(kHeight - 1) * kWidth + 7], 40.0F);

  // An earlier import's amplitudes go when there are none any more.
  EXPECT_EQ(import_json("icl-nuim")["amplitudes"], 0);
  EXPECT_FALSE(fs::exists(dir / "frames/frame-000001.amplitude.png"));

  fs::create_directories(dir / "wide");
  write_png(dir / "wide/1.png",
            GrayImage{kWidth + 1, kHeight, std::vector<std::uint16_t>((kWidth + 1) * kHeight)});
  fs::create_directories(dir / "empty");
  expect_refused_with(call("icl-nuim"),
                      {{{"--amplitude", "wide"}, "wide/1.png"},
                       {{"--amplitude", "empty"}, "empty"},
                       {{"--amplitude", "none"}, "none"},
                       {{"--amplitude", "light", "--amplitude-scale", "0"}, "--amplitude-scale"},
                       {{"--amplitude-scale", "1"}, "goes with --amplitude"}});
}

TEST_F(Recordings, MasksTakePixelsAway) {
  write_scannet_recording();
  Gray8Image mask{kWidth, kHeight, std::vector<std::uint8_t>(kWidth * kHeight)};
  for (const std::size_t k : {5U, 6U, 100U}) mask.pixels[k] = k == 6 ? 1 : 255;  // 5 is 0 before
  fs::create_directories(dir / "masks");
  write_png(dir / "masks/1.png", mask);
  write_png(dir / "masks/other.png", mask);
  json result = import_json("scannet", {"--mask", "masks"});
  EXPECT_EQ(result["masks"], 1);
  EXPECT_EQ(result["masked_pixels"], 2);
  FrameSequence frames = open_frames(dir / "frames", small_sensor());
  EXPECT_EQ(load_frame(frames, 1).depth[6], 0.0F);
  EXPECT_EQ(load_frame(frames, 1).depth[100], 0.0F);
  EXPECT_GT(load_frame(frames, 1).depth[101], 0.0F);
  EXPECT_GT(load_frame(frames, 0).depth[100], 0.0F);
  EXPECT_NE(run_well(call("scannet", {"--mask", "masks"})).find("masks: of 1 frames, 2 pixels"),
            std::string::npos);

  // So do confidences under the least: of 0, 1 and 255 the first, or the first two.
  result = import_json("scannet", {"--confidence", "masks"});
  EXPECT_EQ(result["masks"], 1);
  EXPECT_EQ(load_frame(open_frames(dir / "frames", small_sensor()), 1).depth[101], 0.0F);
  const int zeros = result["masked_pixels"];
  EXPECT_GT(zeros, kWidth * kHeight / 2);
  result = import_json("scannet", {"--confidence", "masks", "--least-confidence", "2"});
  EXPECT_EQ(result["masked_pixels"], zeros + 1);
  result = import_json("scannet", {"--confidence", "masks", "--mask", "masks"});
  EXPECT_EQ(result["masks"], 1);
  EXPECT_EQ(result["masked_pixels"], zeros + 2);

  // Masks lie as the recording's images do.
  fs::remove_all(dir / "rec");
  write_icl_recording();
  result = import_json("icl-nuim", {"--intrinsics", "60,-60,23.5,17.5", "--mask", "masks"});
  EXPECT_EQ(result["masked_pixels"], 2);
  frames = open_frames(dir / "frames", small_sensor());
  EXPECT_EQ(load_frame(frames, 1).at(6, kHeight - 1), 0.0F);
  EXPECT_EQ(load_frame(frames, 1).at(100 % kWidth, kHeight - 1 - 100 / kWidth), 0.0F);
  EXPECT_GT(load_frame(frames, 1).at(6, 0), 0.0F);

  Gray8Image wide{kWidth + 1, kHeight, std::vector<std::uint8_t>((kWidth + 1) * kHeight)};
  fs::create_directories(dir / "wide");
  write_png(dir / "wide/2.png", wide);
  fs::create_directories(dir / "deep");
  write_png(dir / "deep/2.png", image_of(2));
  fs::create_directories(dir / "empty");
  expect_refused_with(call("icl-nuim"), {{{"--mask", "wide"}, "wide/2.png"},
                                         {{"--mask", "deep"}, "deep/2.png"},
                                         {{"--mask", "empty"}, "empty"},
                                         {{"--mask", "none"}, "none"}});
  GrayImage depth = image_of(0, 10, 10);
  EXPECT_THROW((void)apply_mask(mask, depth), Error);
}

TEST_F(Recordings, OnlyAnEarlierImportIsReplaced) {
  write_scannet_recording();
  (void)import_json("scannet");
  write("frames/mine.txt", "mine");
  for (const char* gone : {"rec/depth/4.png", "rec/depth/0.png"}) fs::remove(dir / gone);
  EXPECT_EQ(import_json("scannet")["frames"], 3);
  EXPECT_EQ(
      list("frames"),
      (Strings{"camera-intrinsics.txt", "depth-scale.txt", "frame-000001.depth.png",
               "frame-000001.pose.txt", "frame-000002.depth.png", "frame-000002.pose.txt",
               "frame-000003.depth.png", "frame-000003.pose.txt", "imported.txt", "mine.txt"}));
  write("foreign/frame-000009.depth.png", "mine");
  write_cube();
  run_well({"simulate", "cube.off", "--size", "0.3", "--recenter", "on", "--orbit", "1,0.6,27",
            "--sensor", "small.toml", "--out", "simulated"});
  expect_refused(
      {{{"import", "rec", "--format", "scannet", "--out", "foreign"}, "frame-000009"},
       {{"import", "rec", "--format", "scannet", "--out", "simulated"}, "no file of import"},
       {{"import", "rec", "--format", "scannet", "--out", "rec"}, "SOURCE"},
       {{"import", "rec", "--format", "scannet", "--out", "rec/frames"}, "SOURCE"},
       {{"import", "rec", "--format", "scannet", "--out", "f", "--save-config", "rec/pose/1.txt"},
        "SOURCE"},
       {{"simulate", "cube.off", "--size", "0.3", "--recenter", "on", "--orbit", "1,0.6,27",
         "--sensor", "small.toml", "--out", "frames"},
        "no frames of simulate"}});
}

TEST_F(Recordings, AMapIsMadeOfWhatIsImported) {
  write_scannet_recording();
  (void)import_json("scannet", {"--sensor", "small.toml"});
  // The images are of no scene, which is said; a map is a map.
  const test::ProgramResult made =
      run({"integrate", "frames", "--voxel", "0.1", "--out", "map.vdb", "--json"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const json map = json::parse(made.out);
  EXPECT_EQ(map["frames"], kFrames);
  EXPECT_EQ(map["depth_scale"], 1e-3);
  EXPECT_GT(map["occupied"], 10);
  // What the folder says of its scale holds unless something else is asked for.
  for (const char* scale : {"", "0", "-1", "inf", "1 2", "one"}) {
    write("frames/depth-scale.txt", scale);
    EXPECT_EQ(open_frames(dir / "frames", {}, 0.5).depth_scale, 0.5);
    expect_refused({"integrate", "frames", "--voxel", "0.1", "--out", "new.vdb"},
                   "depth-scale.txt");
  }
  write("frames/depth-scale.txt", "1000");
  expect_refused({"integrate", "frames", "--voxel", "0.1", "--out", "new.vdb"}, "units per metre");
}

TEST_F(Recordings, FlagsThatDoNotFitAreRefused) {
  write_scannet_recording();
  expect_refused(
      {{call("kitti"), "kitti"},
       {call("tum"), "--intrinsics or --sensor"},
       {call("scannet", {"--intrinsics", "60,60,23.5,17.5"}), "--intrinsics"},
       {call("bop", {"--intrinsics", "60,60,23.5,17.5"}), "--intrinsics"},
       {call("scannet", {"--max-time-gap", "0.1"}), "--max-time-gap"},
       {call("tum", {"--sensor", "small.toml", "--max-time-gap", "-1"}), "--max-time-gap -1"},
       {call("tum", {"--sensor", "small.toml", "--max-time-gap", "nan"}), "--max-time-gap"},
       {call("icl-nuim", {"--intrinsics", "60,60,23.5"}), "--intrinsics"},
       {{"import", "nowhere", "--format", "bop", "--out", "frames"}, "nowhere"},
       {{"import", "rec", "--out", "frames"}, "--format"},
       {{"import", "rec", "--format", "scannet"}, "--out"}});
}

TEST_F(Recordings, DamagedTumIsNamed) {
  write_tum_recording();
  const std::string list = read("rec/depth.txt");
  expect_damage_named([this] { write_tum_recording(); }, call("tum", {"--sensor", "small.toml"}),
                      {{"depth.txt", "", "names no image"},
                       {"depth.txt", list + "101.5\n", ":8: "},
                       {"depth.txt", list + "soon depth/0.png\n", "'soon'"},
                       {"depth.txt", list + "101.5 ../0.png\n", ":8: the image '../0.png' is"},
                       {"depth.txt", list + "101.5 /0.png\n", ":8: the image '/0.png' is"},
                       {"depth.txt", list + "100 depth/../../rec/depth/0.png\n", "outside"},
                       {"depth.txt", {}, "", true},
                       {"groundtruth.txt", "101 0 0 0\n", "expected 8 numbers"},
                       {"groundtruth.txt", "101 0 0 0 0 0 0 1.1\n", "norm"}});
}

TEST_F(Recordings, DamagedBopIsNamed) {
  write_bop_recording();
  const json cameras = bop_cameras();
  const auto with = [&cameras](const char* key, const json& value) {
    json changed = cameras;
    changed["20"][key] = value;
    return changed.dump();
  };
  const std::string file = "scene_camera.json";
  expect_damage_named([this] { write_bop_recording(); }, call("bop"),
                      {{file, cameras.dump().substr(0, 300), "parse error"},
                       {file, "[1, 2]", "object"},
                       {file, with("cam_K", {60, 0, 23.5}), "frame 20: cam_K"},
                       {file, with("cam_K", {60, 1, 23.5, 0, 60, 17.5, 0, 0, 1}), "no skew"},
                       {file, with("depth_scale", 0), "depth_scale"}});
}

TEST_F(Recordings, DamagedScanNetIsNamed) {
  write_scannet_recording();
  const std::string intrinsics = "intrinsic/intrinsic_depth.txt";
  expect_damage_named([this] { write_scannet_recording(); }, call("scannet"),
                      {{intrinsics, "60 0 23.5\n0 60 17.5\n0 0 1\n", "found 9"},
                       {intrinsics, "60 0 23.5 0\n0 sixty 17.5 0\n0 0 1 0\n0 0 0 1\n", "'sixty'"},
                       {intrinsics, "0 0 23.5 0\n0 60 17.5 0\n0 0 1 0\n0 0 0 1\n", "fx"},
                       {intrinsics, {}, "", true},
                       {"depth/03.png", bytes_of(image_of(0)), "same number"}});
}

TEST_F(Recordings, DamagedIclNuimIsNamed) {
  write_icl_recording();
  const std::string file = "traj0.gt.freiburg", poses = read("rec/traj0.gt.freiburg");
  expect_damage_named([this] { write_icl_recording(); }, call("icl-nuim"),
                      {{file, "", "no pose"},
                       {"traj1.gt.freiburg", poses, "second"},
                       {"depth/000.png", bytes_of(image_of(0)), "same number"}});
}

TEST_F(Recordings, TheLibraryRefusesWhatItCannotUse) {
  write_scannet_recording();
  const Recording recording = open_recording(dir / "rec", RecordingFormat::scannet);
  EXPECT_EQ(load_depth(recording, 0).pixels, without_saturated(image_of(0)).pixels);
  EXPECT_THROW((void)load_depth(recording, kFrames), Error);
  RecordingConfig config;
  config.max_time_gap = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)open_recording(dir / "rec", RecordingFormat::scannet, config), Error);
  EXPECT_THROW((void)open_recording(dir / "rec", RecordingFormat::tum), Error);
  RecordedFramesWriter writer(dir / "out");
  EXPECT_THROW(writer.commit(recording.camera, 1e-3), Error);
  writer.write_frame(3, image_of(0), pose_of(0));
  EXPECT_THROW(writer.write_frame(3, image_of(0), pose_of(0)), Error);
  EXPECT_THROW(writer.write_frame(4, image_of(0, 40, 30), pose_of(0)), Error);
  EXPECT_THROW(writer.write_frame(4, image_of(0), off_by(pose_of(0), 0.1)), Error);
  EXPECT_THROW(writer.commit(recording.camera, 0), Error);
  PinholeCamera other = recording.camera;
  other.width = 40;
  EXPECT_THROW(writer.commit(other, 1e-3), Error);
  writer.commit(recording.camera, 1e-3);
  EXPECT_EQ(list("out").size(), 5U);
}

}  // namespace
}  // namespace viewgain
