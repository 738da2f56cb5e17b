// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// C corrects frames by a table as C++ does.
#include <gtest/gtest.h>

#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/viewgain.h"

namespace viewgain {
namespace {

TEST(CRangeCalibration, FramesAreCorrectedAsInCpp) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.range_calibration.table = {{0.4, 0.02}, {2.0, 0.03}, {3.5, -0.04}};
  const PinholeCamera& camera = sensor.camera;
  DepthFrame frame{camera.width, camera.height, {}};
  for (int i = 0; i < camera.width * camera.height; ++i) {
    frame.depth.push_back(1e-4F * static_cast<float>(i));
  }
  frame.depth[100] = DepthFrame::kOutOfRange;
  const std::vector<float> before = frame.depth;
  std::vector<float> depth = before;
  sensor.range_calibration.correct(camera, frame);

  vg_sensor own;
  vg_sensor_init(&own, sizeof own);
  ASSERT_EQ(vg_sensor_preset("sr4000", &own), VG_OK) << vg_last_error();
  vg_range_calibration* calibration = nullptr;
  ASSERT_EQ(vg_range_calibration_create(&own, sensor.range_calibration.table.front().data(), 3,
                                        &calibration),
            VG_OK)
      << vg_last_error();
  EXPECT_EQ(vg_range_calibration_correct(calibration, depth.data()), VG_OK) << vg_last_error();
  EXPECT_EQ(depth, frame.depth);
  EXPECT_NE(depth, before);
  vg_range_calibration_release(calibration);
}

}  // namespace
}  // namespace viewgain
