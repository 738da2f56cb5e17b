// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A calibration of ranges gives the same bits from C and from C++, and in many threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/range_calibration.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/viewgain.h"

namespace viewgain {
namespace {

void expect_same_bits(const std::vector<float>& is, const std::vector<float>& expected) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  EXPECT_TRUE(std::equal(is.begin(), is.end(), expected.begin(), expected.end(),
                         [&](float a, float b) { return bits(a) == bits(b); }));
}

TEST(CApiRanges, TheSameBitsAsFromCpp) {
  const RangeCalibration calibration{{{0.5, 0.01}, {1.5, 0.03}, {2.5, -0.05}}};
  int cases = 0;
  for (const double k1 : {0.0, -0.1}) {
    vg_sensor own;
    vg_sensor_init(&own, sizeof own);
    ASSERT_EQ(vg_sensor_preset("sr4000", &own), VG_OK);
    own.distortion[0] = k1;
    PinholeCamera camera = sensor_preset("sr4000").camera;
    camera.distortion[0] = k1;

    DepthFrame frame{camera.width, camera.height, {}};
    for (int i = 0; i < camera.width * camera.height; ++i) {
      frame.depth.push_back(1.37e-4F * static_cast<float>(i));
    }
    frame.depth[9] = DepthFrame::kOutOfRange;
    frame.depth[10] = std::numeric_limits<float>::quiet_NaN();
    frame.depth[11] = -1.F;
    std::vector<std::vector<float>> depths(3, frame.depth);
    calibration.correct(camera, frame);

    vg_range_calibration* handle = nullptr;
    ASSERT_EQ(vg_range_calibration_create(&own, calibration.table[0].data(),
                                          calibration.table.size(), &handle),
              VG_OK)
        << vg_last_error();
    {
      std::vector<std::jthread> threads;
      for (std::vector<float>& depth : depths) {
        threads.emplace_back(
            [&] { EXPECT_EQ(vg_range_calibration_correct(handle, depth.data()), VG_OK); });
      }
    }
    vg_range_calibration_release(handle);
    for (const std::vector<float>& depth : depths) {
      expect_same_bits(depth, frame.depth);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 6);
}

}  // namespace
}  // namespace viewgain
