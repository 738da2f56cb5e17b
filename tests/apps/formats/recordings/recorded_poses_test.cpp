// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Where `viewgain import` finds the poses of a recording's images: transforms and topics of poses.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>

#include "apps/formats/recordings/message_recordings.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

using namespace test;

TEST_F(MessageRecordings, PosesMayComeFromATopic) {
  McapText text;
  add_info(text);
  add_images(text);
  for (int i = 0; i < 20; ++i) {
    const double along = 0.05 * i;
    test::MessageFields pose = text.fields();
    pose.header(100 + along, "map").doubles(std::array<double, 7>{along, 0, 0, 0, 0, 0, 1});
    text.add("/pose", "geometry_msgs/msg/PoseStamped", pose);
    test::MessageFields nameless = text.fields();  // as trackers send them, without a frame
    nameless.header(100 + along, "").doubles(std::array<double, 7>{along, 0, 0, 0, 0, 0, 1});
    text.add("/tracker", "geometry_msgs/msg/PoseStamped", nameless);
    test::MessageFields odometry = text.fields();
    odometry.header(100 + along, "odom").text("link");
    odometry.doubles(std::array<double, 7>{2 * along, 0, 0, 0, 0, 0, 1});
    text.add("/odom", "nav_msgs/msg/Odometry", odometry);
  }
  text.transform("/tf_static", 0, "link", "optical", kStill);
  const auto x_of = [&](std::size_t i) { return open_frames(dir / "frames").poses[i].m[3]; };
  EXPECT_EQ(import(text, {"--pose-topic", "/pose,0,0,0.2,0,0,0,1"})["world"], "map");
  EXPECT_NEAR(x_of(1), 0.15, 1e-9);
  EXPECT_NEAR(open_frames(dir / "frames").poses[1].m[11], 0.2, 1e-9);
  EXPECT_TRUE(import(text, {"--pose-topic", "/tracker,0,0,0.2,0,0,0,1"})["world"].is_null());
  EXPECT_NEAR(x_of(4), 0.45, 1e-9);
  EXPECT_EQ(import(text, {"--pose-topic", "/odom"})["world"], "odom");
  EXPECT_NEAR(x_of(1), 0.1 + 2 * 0.15, 1e-9);
  refuse(text, "/pose does not state the camera's pose on the body", {"--pose-topic", "/pose"});
  Sensor mounted = read_sensor_toml(dir / "small.toml");
  mounted.T_flange_camera = Pose(Eigen::Matrix3d::Identity(), {0, 0, 0.3});
  write_sensor_toml(dir / "small.toml", mounted);
  EXPECT_EQ(import(text, {"--pose-topic", "/pose"})["frames"], kImages);
  EXPECT_NEAR(open_frames(dir / "frames").poses[1].m[11], 0.3, 1e-9);
  refuse(text, "/none has no poses", {"--pose-topic", "/none"});
  (void)import(text, {}, "topics of poses (/odom, /pose, /tracker). They are not used");
  refuse(text, "--pose-topic", {"--pose-topic", "/pose,0,0"});
  refuse(text, "expected a name before the pose", {"--pose-topic", ",0,0,0.2,0,0,0,1"});
}

TEST_F(MessageRecordings, TheCamerasFrameMayBeGiven) {
  // The images say the body's frame, x ahead, as simulators do; no transform leads to the optical.
  McapText text;
  add_transforms(text);
  add_info(text);
  for (std::size_t i = 0; i < kImages; ++i) {
    text.image(kTopic, image_time(i), "link", kWidth, kHeight, "16UC1", rows_mm(i), 2 * kWidth);
  }
  (void)import(text, {}, "If the optical frame is 'optical', give it with --camera-frame");
  (void)import(text, {"--camera-frame", "/optical"});
  expect_frames(open_frames(dir / "frames"));
  (void)import(text, {"--camera-frame", "link,0.1,0,0,0,0,0,1"});
  expect_frames(open_frames(dir / "frames"));
  (void)import(text, {"--camera-frame", "link,0,0,0,-0.5,0.5,-0.5,0.5"});
  const Pose pose = open_frames(dir / "frames").poses[0];
  EXPECT_NEAR(pose.m[2], std::cos(0.005), 1e-9);  // z ahead, which was x
  EXPECT_NEAR(pose.m[9], -1, 1e-9);               // y down
  refuse(text, "no transform leads to the frame 'lens'", {"--camera-frame", "lens"});
  refuse(text, "--camera-frame", {"--camera-frame", "link,0,0"});
  refuse(text, "the camera's pose is given twice",
         {"--camera-frame", "link", "--pose-topic", "/pose,0,0,0,0,0,0,1"});
}

TEST_F(MessageRecordings, RobotsHaveTransformsInTheirNamespaces) {
  McapText text;
  for (int i = 0; i < 11; ++i) {
    const double t = 100 + 0.1 * i;
    text.transform("/other/tf", t, "base", "link", {-7, 0, 0, 0, 0, 0, 1});
    text.transform("/other/tf", t, "room", "base", kStill);
    text.transform("/robot/tf", t, "base", "link", {t, 0, 0, 0, 0, 0, 1});
  }
  text.transform("/tf_static", 0, "link", "optical", kStill);
  add_info(text);
  add_images(text, "/robot/camera/image_raw");
  EXPECT_EQ(import(text, {}, "the intrinsics come from")["world"], "room");
  EXPECT_NEAR(open_frames(dir / "frames").poses[1].m[3], 100.15 + 0.2, 1e-9);
  add_images(text, "/image_raw");
  text.transform("/tf_static", 0, "hall", "room", kStill);
  EXPECT_EQ(import(text, {"--depth-topic", "/robot/camera/image_raw"},
                   "the intrinsics come from")["world"],
            "hall");
  refuse(text, "the transform from 'base' to 'link' comes from several topics",
         {"--depth-topic", "/image_raw"});
  text.transform("/tf", 100, "base", "link", kStill);
  refuse(text, "5 after the last transform", {"--depth-topic", "/image_raw"});
}

TEST_F(MessageRecordings, NothingIsExtrapolated) {
  McapText text;
  add_transforms(text, 100.1, 100.4);  // of images from 100.05 to 100.45
  add_info(text);
  add_images(text);
  EXPECT_EQ(import(text, {}, "1 before the first transform, 1 after the last transform")["bad"],
            (json{{"no_pose", 2}}));
  // Nor are gaps bridged.
  McapText gap;
  add_transforms(gap, 100, 100.1);
  gap.transform("/tf", 101, "base", "link", {1, 0, 0.5, 0, 0, 0, 1});
  add_info(gap);
  add_images(gap);
  const json gaps = import(gap, {}, "4 in gaps between transforms (--max-time-gap)");
  EXPECT_EQ(gaps["frames"], 1);
  EXPECT_NE(gaps.dump().find("the largest gap is 0.9 s, from 'base' to 'link'"), std::string::npos);
  EXPECT_EQ(import(gap, {"--max-time-gap", "1"})["frames"], kImages);
}

TEST_F(MessageRecordings, WorldsAreTold) {
  McapText text = good();
  text.transform("/tf_static", 0, "room", "base", kStill);
  text.transform("/tf_static", 0, "room", "marker", {0, 2, 0, 0, 0, 0, 1});
  EXPECT_EQ(import(text)["world"], "room");
  EXPECT_NEAR(open_frames(dir / "frames").poses[0].m[3], 0.25, 1e-3);
  EXPECT_EQ(import(text, {"--world", "/base"})["world"], "base");
  expect_frames(open_frames(dir / "frames"));
  (void)import(text, {"--world", "marker"});
  EXPECT_NEAR(open_frames(dir / "frames").poses[0].m[7], -2, 1e-3);
  refuse(text, "no transforms connect the world 'moon' and the frame 'optical'",
         {"--world", "moon"});
  // Two worlds.
  McapText two = good();
  for (int i = 0; i < 11; ++i) {
    two.transform("/tf", 100 + 0.1 * i, "marker", "link", {0, 1, 0, 0, 0, 0, 1});
  }
  refuse(two, "is connected to several world frames: 'base', 'marker'; choose one with --world");
  EXPECT_EQ(import(two, {"--world", "base"})["frames"], kImages);
  expect_frames(open_frames(dir / "frames"));
  two.transform("/tf_static", 0, "room", "base", kStill);
  two.transform("/tf_static", 0, "room", "marker", kStill);
  refuse(two, "form a loop");
}

}  // namespace
}  // namespace viewgain
