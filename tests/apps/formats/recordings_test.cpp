// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain import`, and the library behind it, on small recordings that the tests write from poses
// and depths that they know.
#include "viewgain/formats/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr int kWidth = 48, kHeight = 36;
constexpr std::size_t kFrames = 5;
constexpr double kUnit = 1.0 / 5000;  // [m]

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

// What is imported of it.
GrayImage without_saturated(GrayImage image) {
  std::replace(image.pixels.begin(), image.pixels.end(), std::uint16_t{65535}, std::uint16_t{0});
  return image;
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

  // A frame a second, each with its pose.
  void write_plain_recording() const {
    std::string list;
    std::vector<Pose> poses;
    std::vector<double> times;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const std::string image = "depth/" + std::to_string(i) + ".png";
      write_image("rec/" + image, image_of(i));
      list += std::to_string(i) + " " + image + "\n";
      poses.push_back(pose_of(i));
      times.push_back(static_cast<double>(i));
    }
    write("rec/depth.txt", list);
    viewgain::write_tum(dir / "rec/groundtruth.txt", poses, times);
  }
  // Its line of the poses becomes this one.
  void write_pose_line(std::size_t i, const std::string& numbers) const {
    std::istringstream in(read("rec/groundtruth.txt"));
    std::string text;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
      if (line.front() != '#' && number++ == i) line = std::to_string(i) + " " + numbers;
      text += line + "\n";
    }
    write("rec/groundtruth.txt", text);
  }

  static Strings call(const Strings& more = {}) {
    return test::joined({"import", "rec", "--sensor", "small.toml", "--out", "frames"}, more);
  }
  [[nodiscard]] json import_json(Strings more = {}) const {
    more.emplace_back("--json");
    return json::parse(run_well(call(more)));
  }

  [[nodiscard]] std::string small_sensor() const { return (dir / "small.toml").string(); }

  // The folder has every frame to the bit.
  void expect_frames() const {
    const FrameSequence frames = open_frames(dir / "frames");
    EXPECT_EQ(frames.depth_scale, kUnit);
    ASSERT_EQ(frames.images.size(), kFrames);
    EXPECT_EQ(frames.orthonormalized, 0U);
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < kFrames; ++i) {
      EXPECT_EQ(frames.images[i].filename(), "frame-00000" + std::to_string(i) + ".depth.png");
      EXPECT_LE(difference(frames.poses[i], pose_of(i)), 1e-12) << i;
      const DepthFrame frame = load_frame(frames, i);
      const GrayImage image = without_saturated(image_of(i));
      for (std::size_t k = 0; k < image.pixels.size(); ++k, ++pixels) {
        ASSERT_EQ(frame.depth[k], static_cast<float>(image.pixels[k] * kUnit)) << i << ' ' << k;
      }
    }
    EXPECT_EQ(pixels, kFrames * kWidth * kHeight);
  }

  // Each damage alone: exit code 2, one line that names the file, nothing made.
  void expect_damage_named(const std::vector<Damage>& damages) const {
    for (const Damage& damage : damages) {
      fs::remove_all(dir / "rec");
      write_tum_recording();
      if (damage.missing) {
        ASSERT_TRUE(fs::remove(dir / "rec" / damage.file)) << damage.file;
      } else {
        write("rec/" + damage.file, damage.bytes);
      }
      const Strings before = list();
      const test::ProgramResult result = run(call());
      const std::string shown = damage.file + " <- " + damage.bytes.substr(0, 60);
      EXPECT_EQ(result.exit_code, 2) << shown << "\n" << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      EXPECT_NE(result.err.find(damage.file), std::string::npos) << shown << "\n" << result.err;
      EXPECT_NE(result.err.find(damage.word), std::string::npos) << shown << "\n" << result.err;
      EXPECT_EQ(result.out, "") << shown;
      EXPECT_EQ(list(), before) << shown;
    }
  }
  [[nodiscard]] std::string cut_png() const { return read("rec/depth/0.png").substr(0, 200); }
};

// A recording may be of anybody: what it links to elsewhere is none of its frames. What is not
// read, such as the colour images, may be a link.
TEST_F(Recordings, LinksOutOfARecordingAreRefusedWhereTheyAreRead) {
  write_plain_recording();
  fs::create_directory_symlink("depth", dir / "rec/again");  // within
  fs::rename(dir / "rec/depth", dir / "rec/images");
  fs::create_directory_symlink("images", dir / "rec/depth");
  write_image("elsewhere/0.png", image_of(0));
  fs::create_directory_symlink(dir / "elsewhere", dir / "rec/rgb");
  fs::create_symlink("/no/such", dir / "rec/gone");
  EXPECT_EQ(import_json()["frames"], kFrames);
  expect_frames();
  fs::remove(dir / "rec/depth");
  fs::rename(dir / "rec/images", dir / "rec/depth");
  const Strings masked = call({"--mask", "rec/masks"});
  write("rec/masks/1.png", read("rec/depth/1.png"));
  std::size_t cases = 0;
  for (const auto& [link, to] : {std::pair{"rec/depth/0.png", dir / "elsewhere/0.png"},
                                 std::pair{"rec/depth/2.png", fs::path("../../elsewhere/0.png")},
                                 std::pair{"rec/depth/1.png", fs::path("/no/such")},
                                 std::pair{"rec/depth", dir / "elsewhere"},
                                 std::pair{"rec/depth.txt", dir / "elsewhere/depth.txt"},
                                 std::pair{"rec/groundtruth.txt", dir / "elsewhere/depth.txt"},
                                 std::pair{"rec/masks/0.png", dir / "elsewhere/0.png"}}) {
    if (fs::exists(dir / link)) fs::rename(dir / link, dir / "away");
    fs::create_symlink(to, dir / link);
    expect_refused(masked, std::string(link) + ": the link leads out of the recording");
    fs::remove(dir / link);
    if (fs::exists(dir / "away")) fs::rename(dir / "away", dir / link);
    ++cases;
  }
  EXPECT_EQ(cases, 7U);
}

TEST_F(Recordings, ComeThroughExactly) {
  write_tum_recording();
  json result = json::parse(run_well({"import", "rec", "--format", "tum", "--intrinsics",
                                      "60,61,23.5,17.5", "--out", "frames", "--json"}));
  EXPECT_EQ(result["frames"], kFrames);
  EXPECT_TRUE(result["bad"].empty());
  EXPECT_EQ(result["intrinsics"], (json{60, 61, 23.5, 17.5}));
  EXPECT_EQ(result["readings"], kFrames * (kWidth * kHeight - 2));
  EXPECT_TRUE(result["sensor"].is_null());
  // To the bit what the file's quaternions say.
  const PoseList said = read_tum(dir / "rec/groundtruth.txt");
  const FrameSequence frames = open_frames(dir / "frames", small_sensor());
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(frames.poses[i].m, said.poses[2 * i + 1].m) << i;
  }
  EXPECT_EQ(frames.sensor.camera.fy, 61);  // camera-intrinsics.txt
  // By a sensor: intrinsics, noise and ranges.
  result = import_json();
  EXPECT_EQ(result["sensor"], "small");
  EXPECT_EQ(result["intrinsics"], (json{60, 60, 23.5, 17.5}));
  expect_frames();
}

TEST_F(Recordings, WhatCannotBeUsedIsDroppedAndCounted) {
  write_tum_recording();
  write("rec/depth.txt", read("rec/depth.txt") + "90 depth/none.png\n200.5 depth/none.png\n");
  write_image("rec/depth/3.png", image_of(3, 40, 30));
  EXPECT_EQ(import_json()["bad"], (json{{"no_pose", 2}, {"wrong_size", 1}}));
  EXPECT_FALSE(fs::exists(dir / "frames/frame-000003.depth.png"));
  // Within 4.1 ms each has its pose, within 3.9 ms none.
  EXPECT_EQ(import_json({"--max-time-gap", "0.0041"})["frames"], kFrames - 1);
  expect_refused(call({"--max-time-gap", "0.0039"}), "7 no_pose");
  expect_refused(call({"--max-time-gap", "0.0039"}),
                 "has no pose within 0.0039 s (--max-time-gap)");
  const std::string text = run_well(call());
  EXPECT_NE(text.find("left out: 2 no_pose, 1 wrong_size"), std::string::npos) << text;
}

TEST_F(Recordings, AnImageThatIsListedTwiceIsOneFrame) {
  write_plain_recording();
  const std::string list = read("rec/depth.txt");
  write("rec/depth.txt", list + list);
  const json result = import_json();
  EXPECT_EQ(result["bad"], (json{{"changed", kFrames}}));
  EXPECT_EQ(result["frames"], kFrames);
}

TEST_F(Recordings, OneDamagedPoseOrImageIsOneFrameLess) {
  write_plain_recording();
  const std::string poses = read("rec/groundtruth.txt");
  const auto expect_bad = [&](const json& bad) {
    const json result = import_json();
    EXPECT_EQ(result["bad"], bad);
    EXPECT_EQ(result["frames"], kFrames - 1);
  };
  for (const char* lost : {"0 0 0", "nan nan nan nan nan nan nan", "0 0 0 0 0 0 2", "lost"}) {
    write_pose_line(3, lost);
    expect_bad({{"lost_pose", 1}});
  }
  write("rec/groundtruth.txt", poses);
  for (const std::string& damaged : {std::string("no picture"), std::string(), cut_png()}) {
    write("rec/depth/1.png", damaged);
    expect_bad({{"unreadable", 1}});
  }
}

// Of the frames that are taken: a pose that belongs to nobody does not count.
TEST_F(Recordings, RotationsThatAreOffAreMendedAndCounted) {
  write_plain_recording();
  write("rec/groundtruth.txt", read("rec/groundtruth.txt") + "300 0 0 0 0 0 0 1.001\n");
  EXPECT_EQ(import_json()["orthonormalized_poses"], 0);
  write_pose_line(2, "0 0 0 0 0 0 1.001");
  EXPECT_EQ(import_json()["orthonormalized_poses"], 1);
  EXPECT_EQ(open_frames(dir / "frames").poses[2], Pose());
}

TEST_F(Recordings, MasksTakePixelsAway) {
  write_plain_recording();
  Gray8Image mask{kWidth, kHeight, std::vector<std::uint8_t>(kWidth * kHeight)};
  for (const std::size_t k : {5U, 6U, 100U}) mask.pixels[k] = k == 6 ? 1 : 255;  // 5 is 0 before
  fs::create_directories(dir / "masks");
  write_png(dir / "masks/1.png", mask);
  write_png(dir / "masks/other.png", mask);
  json result = import_json({"--mask", "masks"});
  EXPECT_EQ(result["masks"], 1);
  EXPECT_EQ(result["masked_pixels"], 2);
  const FrameSequence frames = open_frames(dir / "frames");
  EXPECT_EQ(load_frame(frames, 1).depth[6], 0.0F);
  EXPECT_EQ(load_frame(frames, 1).depth[100], 0.0F);
  EXPECT_GT(load_frame(frames, 1).depth[101], 0.0F);
  EXPECT_GT(load_frame(frames, 0).depth[100], 0.0F);
  EXPECT_NE(
      run_well(call({"--mask", "masks"})).find("1 frames have a mask; masks removed 2 pixels"),
      std::string::npos);

  // So do confidences under the least: of 0, 1 and 255 the first, or the first two.
  result = import_json({"--confidence", "masks"});
  EXPECT_EQ(result["masks"], 1);
  EXPECT_EQ(load_frame(open_frames(dir / "frames"), 1).depth[101], 0.0F);
  const int zeros = result["masked_pixels"];
  EXPECT_GT(zeros, kWidth * kHeight / 2);
  result = import_json({"--confidence", "masks,2"});
  EXPECT_EQ(result["masked_pixels"], zeros + 1);
  result = import_json({"--confidence", "masks", "--mask", "masks"});
  EXPECT_EQ(result["masks"], 1);
  EXPECT_EQ(result["masked_pixels"], zeros + 2);

  Gray8Image wide{kWidth + 1, kHeight, std::vector<std::uint8_t>((kWidth + 1) * kHeight)};
  fs::create_directories(dir / "wide");
  write_png(dir / "wide/2.png", wide);
  write_image("deep/2.png", image_of(2));
  fs::create_directories(dir / "empty");
  expect_refused_with(call(), {{{"--mask", "wide"}, "wide/2.png"},
                               {{"--mask", "deep"}, "deep/2.png"},
                               {{"--mask", "empty"}, "empty"},
                               {{"--mask", "none"}, "none"}});
  GrayImage depth = image_of(0, 10, 10);
  EXPECT_THROW((void)apply_mask(mask, depth), Error);
}

TEST_F(Recordings, OnlyAnEarlierImportIsReplaced) {
  write_plain_recording();
  (void)import_json();
  write("frames/mine.txt", "mine");
  write("rec/depth.txt", "0 depth/none.png\n1 depth/1.png\n");
  EXPECT_EQ(import_json()["frames"], 1);
  EXPECT_EQ(list("frames"),
            (Strings{"camera-intrinsics.txt", "frame-000001.depth.png", "frame-000001.pose.txt",
                     "frames.toml", "imported.txt", "mine.txt", "sensor.toml"}));
  write("foreign/frame-000009.depth.png", "mine");
  write_cube();
  const Strings simulate{"simulate", "cube.off",   "--size",  "0.3",
                         "--place",  "center",     "--poses", "orbit:1,0.6,27",
                         "--sensor", "small.toml", "--out"};
  run_well(test::joined(simulate, {"simulated"}));
  const Strings import{"import", "rec", "--sensor", "small.toml", "--out"};
  expect_refused({{test::joined(import, {"foreign"}), "frame-000009"},
                  {test::joined(import, {"simulated"}), "import did not write this file"},
                  {test::joined(import, {"rec"}), "SOURCE"},
                  {test::joined(import, {"rec/frames"}), "SOURCE"},
                  {test::joined(import, {"f", "--save-config", "rec/groundtruth.txt"}), "SOURCE"},
                  {test::joined(simulate, {"frames"}), "simulate did not write this file"}});
}

TEST_F(Recordings, AMapIsMadeOfWhatIsImported) {
  write_plain_recording();
  (void)import_json();
  // The images are of no scene, which is said; a map is a map.
  const test::ProgramResult made =
      run({"integrate", "frames", "--voxel", "0.1", "--out", "map.vdb", "--json"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const json map = json::parse(made.out);
  EXPECT_EQ(map["frames"], kFrames);
  EXPECT_EQ(map["depth_scale"], kUnit);
  EXPECT_GT(map["occupied"], 10);
  // What the folder says of its scale holds unless something else is asked for; so does the file of
  // version 0.1.0.
  ASSERT_TRUE(fs::remove(dir / "frames/frames.toml"));
  write("frames/depth-scale.txt", "0.0002\n");
  EXPECT_EQ(open_frames(dir / "frames").depth_scale, 2e-4);
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
  write_plain_recording();
  expect_refused(
      {{{"import", "rec", "--out", "frames"}, "--intrinsics or --sensor"},
       {call({"--max-time-gap", "-1"}), "--max-time-gap -1"},
       {call({"--max-time-gap", "nan"}), "--max-time-gap"},
       {call({"--intrinsics", "60,60,23.5"}), "--intrinsics"},
       {call({"--intrinsics", "60,-60,23.5,17.5"}), "fy"},
       {{"import", "nowhere", "--sensor", "small.toml", "--out", "frames"}, "nowhere"},
       {{"import", "rec", "--format", "bop", "--sensor", "small.toml", "--out", "frames"},
        "unknown format bop; valid values: auto, tum"},
       {{"import", "rec", "--sensor", "small.toml"}, "--out"}});
}

TEST_F(Recordings, WhatIsDamagedIsNamed) {
  write_tum_recording();
  const std::string list = read("rec/depth.txt");
  expect_damage_named({{"depth.txt", "", "lists no image"},
                       {"depth.txt", list + "101.5\n", ":8: "},
                       {"depth.txt", list + "soon depth/0.png\n", "'soon'"},
                       {"depth.txt", list + "101.5 ../0.png\n", ":8: the image '../0.png' is"},
                       {"depth.txt", list + "101.5 /0.png\n", ":8: the image '/0.png' is"},
                       {"depth.txt", list + "100 depth/../../rec/depth/0.png\n", "outside"},
                       {"depth.txt", {}, "", true},
                       {"groundtruth.txt", "101 0 0 0\n", "expected 8 numbers"},
                       {"groundtruth.txt", "101 0 0 0 0 0 0 1.1\n", "norm"}});
}

TEST_F(Recordings, TheLibraryRefusesWhatItCannotUse) {
  write_plain_recording();
  ImportConfig config;
  EXPECT_THROW((void)import_recording(dir / "rec", dir / "frames", config), Error);
  config.camera = read_sensor_toml(small_sensor()).camera;
  config.max_time_gap = -1;
  EXPECT_THROW((void)import_recording(dir / "rec", dir / "frames", config), Error);
}

}  // namespace
}  // namespace viewgain
