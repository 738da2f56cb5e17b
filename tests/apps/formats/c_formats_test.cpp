// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/temporary_folder.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/formats.h"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

TEST(CFormats, SensorsComeBackAsTheyWere) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "mine.toml").string();
  vg_sensor sensor, read;
  vg_sensor_init(&sensor, sizeof sensor);
  vg_sensor_init(&read, sizeof read);
  ASSERT_EQ(vg_sensor_load("d435", &sensor), VG_OK);
  sensor.distortion[1] = 0.125;
  sensor.pose_sigma[0] = 0.004, sensor.pose_sigma[1] = 0.01;
  sensor.scale_sigma = 0.005;
  sensor.out_of_range = VG_OUT_OF_RANGE_CARVE;
  ASSERT_EQ(vg_sensor_save(&sensor, path.c_str()), VG_OK) << vg_last_error();
  ASSERT_EQ(vg_sensor_load(path.c_str(), &read), VG_OK) << vg_last_error();
  EXPECT_EQ(read.width, sensor.width);
  EXPECT_EQ(read.fx, sensor.fx);
  EXPECT_EQ(read.distortion[1], 0.125);
  EXPECT_EQ(read.pose_sigma[0], 0.004);
  EXPECT_EQ(read.pose_sigma[1], 0.01);
  EXPECT_EQ(read.scale_sigma, 0.005);
  EXPECT_EQ(read.out_of_range, VG_OUT_OF_RANGE_CARVE);
  EXPECT_EQ(read.noise_model, sensor.noise_model);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(read.noise[i], sensor.noise[i]) << i;
  EXPECT_EQ(folder.entries(), 1);

  EXPECT_EQ(vg_sensor_load("sr5000", &read), VG_INVALID_ARGUMENT);
  EXPECT_EQ(vg_sensor_load("none.toml", &read), VG_IO);
  EXPECT_NE(std::string(vg_last_error()).find("none.toml"), std::string::npos);
  EXPECT_EQ(vg_sensor_load(folder.file("bad.toml", "width = 3\n").c_str(), &read), VG_FORMAT);
  EXPECT_EQ(vg_sensor_load(nullptr, &read), VG_INVALID_ARGUMENT);
  vg_sensor none{};
  EXPECT_EQ(vg_sensor_load("d435", &none), VG_INVALID_ARGUMENT);  // not initialised
  EXPECT_EQ(vg_sensor_load("d435", nullptr), VG_INVALID_ARGUMENT);
  sensor.min_range = -1;
  EXPECT_EQ(vg_sensor_save(&sensor, path.c_str()), VG_INVALID_ARGUMENT);
  EXPECT_EQ(vg_sensor_save(&read, nullptr), VG_INVALID_ARGUMENT);
}

TEST(CFormats, FramesAreCorrectedByTheFilesTable) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "mine.toml").string();
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.distortion[0] = -0.1;
  sensor.range_calibration.table = {{0.4, 0.02}, {2.0, 0.03}, {3.5, -0.04}};
  write_sensor_toml(path, sensor);
  const PinholeCamera& camera = sensor.camera;
  DepthFrame frame{camera.width, camera.height, {}};
  for (int i = 0; i < camera.width * camera.height; ++i) {
    frame.depth.push_back(1e-4F * static_cast<float>(i));
  }
  frame.depth[100] = DepthFrame::kOutOfRange;
  const DepthFrame before = frame;
  std::vector<float> depth = before.depth;
  sensor.range_calibration.correct(camera, frame);

  vg_range_calibration* calibration = nullptr;
  ASSERT_EQ(vg_range_calibration_load(path.c_str(), &calibration), VG_OK) << vg_last_error();
  ASSERT_EQ(vg_range_calibration_correct(calibration, depth.data()), VG_OK) << vg_last_error();
  EXPECT_EQ(depth, frame.depth);
  EXPECT_NE(depth, before.depth);
  vg_range_calibration_release(calibration);
  // The same of a table of the caller's.
  vg_sensor own;
  vg_sensor_init(&own, sizeof own);
  ASSERT_EQ(vg_sensor_load(path.c_str(), &own), VG_OK) << vg_last_error();
  ASSERT_EQ(vg_range_calibration_create(&own, sensor.range_calibration.table.front().data(), 3,
                                        &calibration),
            VG_OK)
      << vg_last_error();
  depth = before.depth;
  EXPECT_EQ(vg_range_calibration_correct(calibration, depth.data()), VG_OK);
  EXPECT_EQ(depth, frame.depth);
  vg_range_calibration_release(calibration);

  // What C saves has no table; without one frames stay as they are.
  ASSERT_EQ(vg_sensor_save(&own, path.c_str()), VG_OK) << vg_last_error();
  EXPECT_TRUE(read_sensor_toml(path).range_calibration.table.empty());
  for (const std::string& name : {path, std::string("sr4000")}) {
    ASSERT_EQ(vg_range_calibration_load(name.c_str(), &calibration), VG_OK) << vg_last_error();
    depth = before.depth;
    EXPECT_EQ(vg_range_calibration_correct(calibration, depth.data()), VG_OK) << vg_last_error();
    EXPECT_EQ(depth, before.depth) << name;
    vg_range_calibration_release(calibration);
  }

  const auto refused = [&](const char* name, vg_status status, const char* part) {
    calibration = reinterpret_cast<vg_range_calibration*>(&own);
    EXPECT_EQ(vg_range_calibration_load(name, &calibration), status) << part;
    EXPECT_EQ(calibration, nullptr) << part;
    EXPECT_NE(std::string(vg_last_error()).find(part), std::string::npos) << vg_last_error();
  };
  refused("sr5000", VG_INVALID_ARGUMENT, "sr5000");
  refused("none.toml", VG_IO, "none.toml");
  refused(nullptr, VG_INVALID_ARGUMENT, "preset_or_file is null");
  refused(folder.file("bad.toml", "width = 3\n").c_str(), VG_FORMAT, "bad.toml");
  EXPECT_EQ(vg_range_calibration_load(path.c_str(), nullptr), VG_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace viewgain
