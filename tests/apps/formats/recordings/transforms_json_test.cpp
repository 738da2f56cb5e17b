// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// `viewgain import` on transforms.json of nerfstudio and instant-ngp.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

constexpr int kWidth = 48, kHeight = 36;

Pose pose_of(std::size_t i) {
  return look_at({0.6, 0.1 * static_cast<double>(i), 0.3}, {0, 0, 0.02});
}

class TransformsJson : public test::ProgramTest {
 protected:
  TransformsJson() {
    write_small_sensor();
    fs::create_directories(dir / "scene/depth");
  }

  // Camera to world with y up and the view along -z.
  static json frame_of(std::size_t i) {
    const Pose pose = pose_of(i);
    json rows = json::array();
    for (std::size_t r = 0; r < 3; ++r) {
      rows.push_back({pose.m[4 * r], -pose.m[4 * r + 1], -pose.m[4 * r + 2], pose.m[4 * r + 3]});
    }
    rows.push_back({0, 0, 0, 1});
    return {{"file_path", "images/" + std::to_string(i) + ".jpg"},
            {"depth_file_path", "./depth/" + std::to_string(i) + ".png"},
            {"transform_matrix", rows}};
  }
  json good(int width = kWidth, int height = kHeight) const {
    json scene{{"camera_model", "OPENCV"},
               {"w", width},
               {"h", height},
               {"fl_x", 60},
               {"fl_y", 61},
               {"cx", 24},
               {"cy", 18},
               {"k1", 0.1},
               {"frames", json::array()}};
    for (std::size_t i = 0; i < 3; ++i) {
      GrayImage image{kWidth, kHeight, {}};
      for (int k = 0; k < kWidth * kHeight; ++k) {
        image.pixels.push_back(static_cast<std::uint16_t>(500 + k));
      }
      write_png(dir / "scene/depth" / (std::to_string(i) + ".png"), image);
      scene["frames"].push_back(frame_of(i));
    }
    return scene;
  }
  static Strings call(Strings more = {}) {
    return test::joined({"import", "scene", "--sensor", "small.toml", "--out", "frames"}, more);
  }
  [[nodiscard]] json import(const json& scene, const Strings& more = {}) const {
    write("scene/transforms.json", scene.dump());
    return json::parse(run_well(test::joined(call(more), {"--json"})));
  }
  void refuse(const json& scene, const std::string& word) const {
    write("scene/transforms.json", scene.dump());
    expect_refused(call(), word);
  }
};

TEST_F(TransformsJson, ComesThrough) {
  const json report = import(good());
  EXPECT_EQ(report["format"], "transforms");
  EXPECT_EQ(report["frames"], 3);
  EXPECT_EQ(report["depth_scale"], 0.001);
  EXPECT_EQ(report["intrinsics"], (json{60, 61, 23.5, 17.5}));
  const FrameSequence frames = open_frames(dir / "frames");
  EXPECT_EQ(frames.sensor.camera.distortion[0], 0.1);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(frames.poses[i].m[k], pose_of(i).m[k], 1e-12);
    EXPECT_NEAR(load_frame(frames, i).depth[7], 0.507, 1e-6);
  }
  // The file itself; as instant-ngp spells it, in its own unit; masks.
  json scene = good();
  for (json& frame : scene["frames"]) {
    frame["depth_path"] = frame["depth_file_path"];
    frame.erase("depth_file_path");
  }
  scene["integer_depth_scale"] = 0.0005;
  EXPECT_EQ(import(scene)["depth_scale"], 0.0005);
  EXPECT_EQ(import(scene, {"--depth-scale", "0.0001"})["depth_scale"], 0.0001);
  run_well({"import", "scene/transforms.json", "--sensor", "small.toml", "--out", "frames"});
  fs::create_directories(dir / "masks");
  write_png(dir / "masks/1.png", Gray8Image{kWidth, kHeight, std::vector<std::uint8_t>(1728, 1)});
  EXPECT_EQ(import(good(), {"--mask", "masks"})["masked_pixels"], 1728);
}

TEST_F(TransformsJson, IntrinsicsAreScaledToTheDepthImages) {
  json scene = good(4 * kWidth, 4 * kHeight);
  scene["fl_x"] = 240, scene["fl_y"] = 240, scene["cx"] = 96, scene["cy"] = 72;
  write("scene/transforms.json", scene.dump());
  const test::ProgramResult result = run(call({"--json"}));
  EXPECT_NE(result.err.find("are scaled accordingly"), std::string::npos) << result.err;
  EXPECT_EQ(json::parse(result.out)["intrinsics"], (json{60, 60, 23.5, 17.5}));
  // An angle in place of a focal length.
  scene = good();
  scene.erase("fl_x"), scene.erase("fl_y");
  scene["camera_angle_x"] = 2 * std::atan(0.4);
  EXPECT_NEAR(double(import(scene)["intrinsics"][0]), 60, 1e-9);
  EXPECT_NEAR(double(import(scene)["intrinsics"][1]), 60, 1e-9);
}

TEST_F(TransformsJson, FramesAndTheTopShareTheCamera) {
  // The focal length by the frames, the rest by the top.
  json scene = good();
  scene.erase("fl_x"), scene.erase("fl_y");
  for (json& frame : scene["frames"]) frame["fl_x"] = 60, frame["fl_y"] = 61;
  EXPECT_EQ(import(scene)["intrinsics"], (json{60, 61, 23.5, 17.5}));
  EXPECT_EQ(open_frames(dir / "frames").sensor.camera.distortion[0], 0.1);
  // A frame's own angle comes before the top's focal length.
  scene = good();
  scene.erase("fl_y");
  for (json& frame : scene["frames"]) frame["camera_angle_x"] = 2 * std::atan(0.3);
  EXPECT_NEAR(double(import(scene)["intrinsics"][0]), 80, 1e-9);
  // The other way round: the size and the middle by the frames.
  scene = good();
  for (const char* key : {"w", "h", "cx", "cy"}) scene.erase(key);
  for (json& frame : scene["frames"]) frame["cx"] = 20, frame["w"] = kWidth, frame["h"] = kHeight;
  EXPECT_EQ(import(scene)["intrinsics"], (json{60, 61, 19.5, 17.5}));
  scene["frames"][2]["cx"] = 21;
  refuse(scene, "frame 2 has a different camera");
  // Without a size it is the images'.
  scene = good();
  for (const char* key : {"w", "h", "cx", "cy", "fl_x", "fl_y"}) scene.erase(key);
  scene["camera_angle_x"] = 2 * std::atan(0.4);
  EXPECT_NEAR(double(import(scene)["intrinsics"][0]), 60, 1e-9);
  EXPECT_EQ(import(scene)["intrinsics"][2], 23.5);
  EXPECT_EQ(import(scene)["intrinsics"][3], 17.5);
  scene["w"] = kWidth;
  refuse(scene, "w and h");
}

TEST_F(TransformsJson, OneBadFrameIsOneLess) {
  json scene = good();
  scene["frames"].push_back(frame_of(0));
  scene["frames"].push_back({{"file_path", "a.jpg"}, {"transform_matrix", json::array()}});
  scene["frames"].push_back(frame_of(7));
  scene["frames"][0]["transform_matrix"][0][0] = 9;
  scene["frames"][1].erase("transform_matrix");
  EXPECT_EQ(import(scene)["bad"], (json{{"lost_pose", 1}, {"no_pose", 1}, {"unreadable", 2}}));
}

TEST_F(TransformsJson, WhatCannotBeReadIsNamed) {
  json scene = good();
  scene["frames"][0]["depth_file_path"] = "../small.toml";
  refuse(scene, "'../small.toml' is outside the recording");
  scene = good();
  scene["camera_model"] = "OPENCV_FISHEYE";
  refuse(scene, "'OPENCV_FISHEYE' is not supported");
  write("scene/transforms.json", scene.dump());
  expect_refused(call({"--intrinsics", "60,60,23.5,17.5"}), "'OPENCV_FISHEYE' is not supported");
  scene.erase("fl_x"), scene.erase("fl_y");
  for (json& frame : scene["frames"]) frame["fl_x"] = 60;
  refuse(scene, "'OPENCV_FISHEYE' is not supported");
  scene = good();
  scene["frames"][1]["is_fisheye"] = true;
  refuse(scene, "'is_fisheye' is not supported");
  scene = good();
  scene["k4"] = 0.1;
  refuse(scene, "'k4' is not supported");
  scene = good();
  scene.erase("fl_x"), scene.erase("fl_y");
  refuse(scene, "has no focal length");
  scene = good();
  scene["fl_x"] = "sixty";
  refuse(scene, "fl_x is not a finite number");
  scene = good();
  scene["frames"][0]["fl_x"] = 60, scene["frames"][1]["fl_x"] = 61;
  refuse(scene, "frame 1 has a different camera");
  scene = good();
  scene["integer_depth_scale"] = 7;
  refuse(scene, "depth scale 7");
  refuse({{"frames", json::array()}}, "has no frames");
  write("scene/transforms.json", "{\"frames\": [");
  expect_refused(call(), "is not JSON with a list");
  const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
  write("scene/transforms.json", R"({"frames": [], "deep": )" + deep + "}");
  expect_refused(call(), "is not JSON with a list");
  for (const auto& [key, value] : {std::pair("fl_x", -60.0), std::pair("cx", 1e9)}) {
    scene = good();
    scene[key] = value;
    write("scene/transforms.json", scene.dump());
    refuse(scene, "transforms.json: camera: ");
  }
  write("scene/transforms.json", good().dump());
  expect_refused(call({"--world", "map"}),
                 "--world map: this flag requires a recording of ROS messages");
  fs::remove(dir / "scene/depth/0.png");
  fs::create_symlink("/etc/passwd", dir / "scene/depth/0.png");
  expect_refused(call(), "the link leads out of the recording");
}

}  // namespace
}  // namespace viewgain
