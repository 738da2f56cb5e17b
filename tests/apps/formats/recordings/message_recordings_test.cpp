// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain import` on small recordings of messages that the tests write: encodings, cameras, poses
// and what is broken.
#include "apps/formats/recordings/message_recordings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

using namespace test;

TEST_F(MessageRecordings, ComeThroughInEveryEncoding) {
  for (const Kind kind : {Kind::little_cdr, Kind::big_cdr, Kind::little_cdr2, Kind::ros1}) {
    const json report = import(good(kind));
    EXPECT_EQ(report["frames"], kImages);
    EXPECT_EQ(report["format"], "mcap");
    EXPECT_EQ(report["world"], "base");
    EXPECT_EQ(report["depth_topic"], kTopic);
    EXPECT_EQ(report["depth_scale"], 0.001);
    EXPECT_EQ(report["intrinsics"], (json{61, 62, 23, 17}));
    expect_frames(open_frames(dir / "frames"));
  }
  // Bytes in the other order, longer rows, mono16.
  McapText text;
  add_transforms(text);
  add_info(text);
  for (std::size_t i = 0; i < kImages; ++i) {
    text.image(kTopic, image_time(i), "/optical", kWidth, kHeight, "mono16", rows_mm(i, true, 6),
               2 * kWidth + 6, true);
  }
  EXPECT_EQ(import(text)["frames"], kImages);
  expect_frames(open_frames(dir / "frames"));
  EXPECT_EQ(import(text, {"--depth-scale", "0.0005"})["depth_scale"], 0.0005);
}

TEST_F(MessageRecordings, FloatsAreAsRep117HasThem) {
  McapText text;
  add_transforms(text);
  add_info(text);
  std::string rows;
  for (std::size_t k = 0; k < kWidth * kHeight; ++k) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::array<float, 5> first{kInfinity, -kInfinity, std::nanf(""), -1.0F, 0.0F};
    const float z = k < 5 ? first[k] : 0.5F + 0.0001F * static_cast<float>(k);
    rows.append(reinterpret_cast<const char*>(&z), sizeof z);
  }
  text.image(kTopic, image_time(0), "optical", kWidth, kHeight, "32FC1", rows, 4 * kWidth);
  EXPECT_EQ(import(text)["readings"], kWidth * kHeight - 5);
  const DepthFrame frame = load_frame(open_frames(dir / "frames"), 0);
  EXPECT_EQ(frame.depth[0], DepthFrame::kOutOfRange);
  for (std::size_t k = 1; k < 5; ++k) EXPECT_EQ(frame.depth[k], DepthFrame::kInvalid);
  EXPECT_NEAR(frame.depth[100], 0.51, 5e-5);
}

// What image_transport makes of floats: inverse depths as a PNG, and how they were quantised.
TEST_F(MessageRecordings, CompressedFloatsAreInverseDepths) {
  GrayImage inverse{kWidth, kHeight, {}};
  for (std::size_t k = 0; k < kWidth * kHeight; ++k) {
    inverse.pixels.push_back(static_cast<std::uint16_t>(k == 5 ? 0 : 900 + k));
  }
  write_png(dir / "inverse.png", inverse);
  const std::array<float, 2> quantised{1000, -100};
  std::string data(4, '\0');
  data.append(reinterpret_cast<const char*>(quantised.data()), sizeof quantised);
  const auto recording = [&](const std::string& format, const std::string& png) {
    McapText text;
    add_transforms(text);
    add_info(text);
    test::MessageFields message = text.fields();
    message.header(image_time(0), "optical").text(format).blob(data + png);
    text.add("/camera/depth/image_raw/compressedDepth", "sensor_msgs/msg/CompressedImage", message);
    return text;
  };
  EXPECT_EQ(import(recording("32FC1; compressedDepth png", read("inverse.png")))["frames"], 1);
  const DepthFrame frame = load_frame(open_frames(dir / "frames"), 0);
  for (std::size_t k = 0; k < frame.depth.size(); ++k) {
    const double z = k == 5 ? 0 : 1000.0 / (1000.0 + static_cast<double>(k));
    ASSERT_NEAR(frame.depth[k], z, 6e-5) << k;
  }
  refuse(recording("16UC1; compressedDepth rvl", "\1\2\3\4"), "only supported as PNG");
  refuse(recording("rgb8; jpeg compressed bgr8", "\xff\xd8"), "no topic has depth images");
}

TEST_F(MessageRecordings, CamerasAreThoseOfTheImages) {
  const auto camera_of = [&](const Camera& camera, const std::string& topic) {
    McapText text;
    add_transforms(text);
    add_info(text, camera);
    add_images(text, topic);
    EXPECT_EQ(import(text)["frames"], kImages);
    return open_frames(dir / "frames").sensor.camera;
  };
  const std::vector<double> lens{0.1, -0.05, 0.001, 0.002, 0.01};
  // Rectified: P without distortion; raw: K and D.
  const PinholeCamera rectified = camera_of({.d = lens}, "/camera/depth/image_rect");
  EXPECT_EQ(rectified, (PinholeCamera{48, 36, 60, 60, 23.5, 17.5, {}}));
  const PinholeCamera raw = camera_of({.d = lens}, kTopic);
  EXPECT_EQ(raw, (PinholeCamera{48, 36, 61, 62, 23, 17, {0.1, -0.05, 0.001, 0.002, 0.01}}));
  EXPECT_EQ(
      camera_of({.model = "rational_polynomial", .d = {0.1, -0.05, 0.001, 0.002, 0.01, 0, 0, 0}},
                kTopic),
      raw);
  // A region from (10, 4) of a larger image, and every second pixel of that.
  const PinholeCamera region = camera_of({.size = {640, 480}, .roi = {10, 4, 36, 48}}, kTopic);
  EXPECT_EQ(region, (PinholeCamera{48, 36, 61, 62, 13, 13, {}}));
  const PinholeCamera binned =
      camera_of({.size = {640, 480}, .binning = {2, 2}, .roi = {10, 4, 72, 96}}, kTopic);
  EXPECT_EQ(binned, (PinholeCamera{48, 36, 30.5, 31, 6.25, 6.25, {}}));
  // The second camera of a stereo pair stands 0.05 m to the right.
  (void)camera_of({.stereo = -3}, "/camera/depth/image_rect");
  EXPECT_NEAR(open_frames(dir / "frames").poses[0].m[3], 0.05 + 0.15 * std::cos(0.005), 1e-9);

  const auto with = [](const Camera& camera) {
    McapText text;
    add_transforms(text);
    add_info(text, camera);
    add_images(text);
    return text;
  };
  refuse(with({.model = "rational_polynomial", .d = {0.1, 0, 0, 0, 0, 0.2, 0, 0}}),
         "'rational_polynomial' with 8 coefficients is not supported");
  refuse(with({.model = "equidistant", .d = {0.1, 0, 0, 0}}), "'equidistant'");
  write("rec.mcap", with({.d = lens}).bytes());
  expect_refused({"import", "rec.mcap", "--out", "frames"}, "give --sensor");
  EXPECT_EQ(import(with({.size = {40, 30}}), {"--intrinsics", "60,60,23.5,17.5"})["width"], 48);
  refuse(with({.size = {40, 30}}), "48x36 pixels, but the camera has 40x30; give --intrinsics");
  // Without a camera_info there is none, or the sensor's.
  McapText text;
  add_transforms(text);
  add_images(text);
  EXPECT_EQ(import(text, {}, "the intrinsics of --sensor are used")["intrinsics"],
            (json{60, 60, 23.5, 17.5}));
  expect_refused({"import", "rec.mcap", "--out", "new"}, "no camera_info belongs to");
  // That of another frame is named, to be given by hand.
  MessageFields other = text.fields();
  other.header(100, "lens").put(kHeight).put(kWidth).text("plumb_bob").put(std::uint32_t{0});
  other.doubles(std::array<double, 9>{61, 0, 23, 0, 62, 17.5, 0, 0, 1});
  other.doubles(std::array<double, 21>{}).put(std::array<char, 25>{});
  text.add("/calib/camera_info", "sensor_msgs/msg/CameraInfo", other);
  write("rec.mcap", text.bytes());
  expect_refused({"import", "rec.mcap", "--out", "new"},
                 "/calib/camera_info (frame 'lens', 48x36 px, --intrinsics 61,62,23,17.5)");
}

TEST_F(MessageRecordings, OneOfSeveralTopicsIsChosen) {
  McapText text = good();
  add_images(text, "/other/image_raw");
  refuse(text,
         "several topics have depth images: /camera/depth/image_raw (sensor_msgs/Image, "
         "16UC1, 5 messages), /other/image_raw (");
  EXPECT_EQ(import(text, {"--depth-topic", kTopic})["frames"], kImages);
  // The other one has no camera_info beside it, but the same frame.
  EXPECT_EQ(import(text, {"--depth-topic", "/other/image_raw"},
                   "the intrinsics come from /camera/depth/camera_info")["frames"],
            kImages);
  // Where both are recorded, the compressed images are those of the raw topic.
  McapText twice = good();
  MessageFields packed = twice.fields();
  packed.header(100.3, "optical").text("16UC1; compressedDepth png");
  packed.blob(std::string(12, '\0') + "\x89PNG");
  const std::string copy = std::string(kTopic) + "/compressedDepth";
  twice.add(copy, "sensor_msgs/msg/CompressedImage", packed);
  EXPECT_EQ(import(twice)["depth_topic"], kTopic);
  refuse(twice, "1 unreadable", {"--depth-topic", copy});
  refuse(text, "has no topic /none (--depth-topic)", {"--depth-topic", "/none"});
  refuse(text, "/tf (tf2_msgs/TFMessage, 11 messages) has no depth images",
         {"--depth-topic", "/tf"});
}

TEST_F(MessageRecordings, WhatIsBrokenIsNamed) {
  McapText no_tf;
  add_info(no_tf);
  add_images(no_tf);
  refuse(no_tf, "has no transforms; record /tf and /tf_static");
  McapText of_others = no_tf;
  of_others.transform("/tf", 100, "base", "link", kStill);
  refuse(of_others, "no transform leads to the frame 'optical'; existing frames: 'base', 'link'");
  McapText top = no_tf;
  top.transform("/tf", 100, "optical", "link", kStill);
  refuse(top, "has no parent frame, so the camera would never move");
  refuse(McapText(), "has no messages");
  McapText no_depth;
  add_transforms(no_depth);
  refuse(no_depth, "no topic has depth images");
  McapText json_text = no_depth;
  json_text.add("/depth", "foxglove.RawImage", json_text.fields(), "protobuf");
  refuse(json_text, "/depth (foxglove.RawImage, 1 messages) in an unknown encoding");
  // Clocks that are not the same.
  McapText clocks;
  add_transforms(clocks, 900, 901);
  add_info(clocks);
  add_images(clocks);
  refuse(clocks, "The clocks of the camera and the robot differ");
  // An empty image, a damaged one, a quaternion that is none.
  McapText some = good();
  some.image(kTopic, 100.3, "optical", kWidth, kHeight, "16UC1", "short", 2 * kWidth);
  some.image(kTopic, 100.3, "optical", kWidth, kHeight, "rgb8", rows_mm(0), 2 * kWidth);
  some.image(kTopic, 100.3, "optical", 8, 8, "16UC1", std::string(128, '\1'), 16);
  test::MessageFields cut = some.fields();
  some.add(kTopic, "sensor_msgs/msg/Image", cut.put(std::uint32_t{5}));
  some.transform("/tf", 100.35, "base", "link", {0, 0, 0, 0, 0, 0, 2});
  some.transform("/tf", 100.35, "link", "link", kStill);
  const json report = import(some, {}, "transforms that are damaged or not rigid are left out: 2");
  EXPECT_EQ(report["frames"], kImages);
  EXPECT_EQ(report["bad"], (json{{"unreadable", 3}, {"wrong_size", 1}}));
  EXPECT_EQ(report["warnings"].size(), 2);
}

TEST_F(MessageRecordings, WhatIsSuspiciousIsSaid) {
  McapText wrong;
  add_transforms(wrong);
  add_info(wrong);
  for (std::size_t i = 0; i < kImages; ++i) {
    wrong.image(kTopic, image_time(i), "optical", kWidth, kHeight, "16UC1", rows_mm(i, true),
                2 * kWidth);
  }
  (void)import(wrong, {}, "Is is_bigendian wrong?");
  McapText back = good();
  add_images(back);
  EXPECT_EQ(
      import(back, {}, "images with an earlier time stamp than the image before them: 1")["frames"],
      2 * kImages);
  McapText twice = good();
  add_transforms(twice);
  (void)import(twice, {}, "the time stamps from 'base' to 'link' go back by 1 s");
  McapText other_lens = good();
  add_info(other_lens, {.size = {96, 72}});
  (void)import(other_lens, {}, "1 messages differ from the first message");
  McapText unclear;
  add_transforms(unclear);
  add_info(unclear, {.d = {0.1, 0, 0, 0, 0}});
  add_images(unclear, "/camera/depth/image");
  (void)import(unclear, {}, "contains neither raw nor rect");
}

// Every cut of a file is read as far as it goes, or refused in one line.
TEST_F(MessageRecordings, CutsAreReadAsFarAsTheyGo) {
  const std::string bytes = good().bytes();
  std::size_t last = 0, cases = 0;
  for (std::size_t length = 0; length < bytes.size() - 60; length += bytes.size() / 40) {
    write("rec.mcap", bytes.substr(0, length));
    const test::ProgramResult result = run(call({"--json"}));
    ++cases;
    if (result.exit_code == 0) {
      const std::size_t frames = json::parse(result.out)["frames"];
      EXPECT_GE(frames, last);
      EXPECT_NE(result.err.find("the complete records are used"), std::string::npos) << result.err;
      last = frames;
    } else {
      EXPECT_EQ(result.exit_code, 2) << length;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      EXPECT_NE(result.err.find("rec.mcap"), std::string::npos) << result.err;
    }
  }
  EXPECT_GE(cases, 39U);
  EXPECT_EQ(last, kImages - 1);
  // A recorder that was ended leaves whole records and no end.
  write("rec.mcap", good().bytes(false));
  EXPECT_EQ(json::parse(run(call({"--json"})).out)["frames"], kImages);
}

TEST_F(MessageRecordings, FlagsAndFilesThatDoNotFitAreRefused) {
  write("rec.mcap", good().bytes());
  fs::create_directories(dir / "both");
  fs::copy_file(dir / "rec.mcap", dir / "both/a.mcap");
  write("both/b.bag", "#ROSBAG V2.0\n");
  write("text.mcap", "no recording at all");
  write("old.bag", "#ROSBAG V1.2\n");
  write("whole.db3.zstd", "\x28\xb5\x2f\xfd and more");
  write("empty.db3", "SQLite format 3");
  fs::create_directories(dir / "none");
  fs::create_directories(dir / "packed");
  write("packed/rec_0.db3.zstd", "\x28\xb5\x2f\xfd and more");
  const auto import = [](const std::string& source, const Strings& more = {}) {
    return test::joined({"import", source, "--sensor", "small.toml", "--out", "frames"}, more);
  };
  expect_refused({{import("rec.mcap", {"--format", "tum"}), "has the format mcap"},
                  {import("rec.mcap", {"--mask", "none"}),
                   "masks cannot be used with a recording of ROS messages"},
                  {import("rec.mcap", {"--depth-scale", "2"}), "between 0 and 1"},
                  {import("rec.mcap", {"--depth-scale", "-1"}), "--depth-scale"},
                  {import("both"), "two kinds, .mcap and .bag"},
                  {import("none"), "the folder has no recording"},
                  {import("packed"), "unzstd"},
                  {import("text.mcap"), "is not a recording"},
                  {import("old.bag"), "rosbag fix"},
                  {import("whole.db3.zstd"), "unzstd"},
                  {import("empty.db3"), "empty.db3"},
                  {import("nowhere.mcap"), "nowhere.mcap"}});
}

}  // namespace
}  // namespace viewgain
