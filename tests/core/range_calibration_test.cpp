// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/range_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "expect_error.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"

namespace viewgain {
namespace {

using test::expect_error;

TEST(RangeCalibration, EmptyCorrectsNothing) {
  const RangeCalibration none;
  EXPECT_NO_THROW(none.validate());
  EXPECT_EQ(none.corrected(1.25), 1.25);
}

TEST(RangeCalibration, InterpolatesAndHoldsTheEnds) {
  const RangeCalibration calibration{{{1.0, 0.01}, {2.0, 0.03}, {4.0, -0.05}}};
  EXPECT_NO_THROW(calibration.validate());
  EXPECT_NEAR(calibration.corrected(1.0), 0.99, 1e-15);
  EXPECT_NEAR(calibration.corrected(1.5), 1.48, 1e-15);
  EXPECT_NEAR(calibration.corrected(2.0), 1.97, 1e-15);
  EXPECT_NEAR(calibration.corrected(3.0), 3.01, 1e-15);
  EXPECT_NEAR(calibration.corrected(4.0), 4.05, 1e-15);
  EXPECT_NEAR(calibration.corrected(0.2), 0.19, 1e-15);
  EXPECT_NEAR(calibration.corrected(9.0), 9.05, 1e-15);
  const RangeCalibration offset{{{1.0, 0.02}}};
  EXPECT_NEAR(offset.corrected(0.5), 0.48, 1e-15);
  EXPECT_NEAR(offset.corrected(1.0), 0.98, 1e-15);
  EXPECT_NEAR(offset.corrected(5.0), 4.98, 1e-15);
}

// Readings that were off by a known curve come back to the truth.
TEST(RangeCalibration, TakesASmoothErrorAway) {
  const auto error = [](double truth) { return 0.01 * std::sin(5 * truth); };
  RangeCalibration calibration;
  for (int i = 0; i <= 100; ++i) {
    const double truth = 0.5 + 0.02 * i;
    calibration.table.push_back({truth + error(truth), error(truth)});
  }
  calibration.validate();
  int cases = 0;
  double worst = 0;
  for (double truth = 0.505; truth < 2.5; truth += 0.0137, ++cases) {
    worst = std::max(worst, std::abs(calibration.corrected(truth + error(truth)) - truth));
  }
  EXPECT_EQ(cases, 146);
  EXPECT_LT(worst, 2e-5);  // step² / 8 times the curvature, 1.25e-5, and its change
}

// The depth of a reading goes with its range, along the ray of its pixel.
TEST(RangeCalibration, CorrectsTheReadingsOfAFrameAlongTheirRays) {
  const RangeCalibration calibration{{{1.0, 0.01}, {2.0, 0.03}, {4.0, -0.05}}};
  PinholeCamera camera{7, 5, 4.0, 5.0, 2.5, 2.25, {}};
  int cases = 0;
  for (const double k1 : {0.0, -0.1}) {
    camera.distortion[0] = k1;
    DepthFrame frame{7, 5, {}};
    for (int i = 0; i < 35; ++i) frame.depth.push_back(0.4F + 0.1F * static_cast<float>(i));
    frame.depth[3] = DepthFrame::kInvalid;
    frame.depth[4] = DepthFrame::kOutOfRange;
    frame.amplitude.assign(35, 2.F);
    frame.known_depth.assign(35, 1.F);
    const DepthFrame before = frame;
    calibration.correct(camera, frame);
    EXPECT_EQ(frame.amplitude, before.amplitude);
    EXPECT_EQ(frame.known_depth, before.known_depth);
    for (int v = 0; v < 5; ++v) {
      for (int u = 0; u < 7; ++u) {
        const float depth = before.at(u, v);
        if (depth == DepthFrame::kInvalid || depth == DepthFrame::kOutOfRange) {
          EXPECT_EQ(frame.at(u, v), depth);
          continue;
        }
        const Eigen::Vector3d direction = camera.ray(u, v).normalized();
        const double range = depth / direction.z();
        EXPECT_NEAR(frame.at(u, v), calibration.corrected(range) * direction.z(), 1e-6);
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 66);
}

TEST(RangeCalibration, WhatIsNoRangeAfterItIsInvalid) {
  const PinholeCamera camera{2, 1, 1.0, 1.0, 0.0, 0.0, {}};
  DepthFrame frame{2, 1, {0.01F, 1.F}};
  RangeCalibration{{{1.0, 0.02}}}.correct(camera, frame);
  EXPECT_EQ(frame.depth[0], DepthFrame::kInvalid);
  EXPECT_NEAR(frame.depth[1], (std::sqrt(2.0) - 0.02) / std::sqrt(2.0), 1e-6);
  const DepthFrame before = frame;
  RangeCalibration{}.correct(camera, frame);
  EXPECT_EQ(frame, before);
  frame.width = 3;
  expect_error(ErrorCode::invalid_argument, "3",
               [&] { RangeCalibration{}.correct(camera, frame); });
}

TEST(RangeCalibration, RefusesTablesThatDoNotRiseOrAreNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto refused = [](const RangeCalibration& table, const char* word) {
    expect_error(ErrorCode::invalid_argument, word, [&] { table.validate(); });
  };
  refused({{{1, 0}, {1, 0}}}, "rise");
  refused({{{1, 0}, {2, 0}, {1.5, 0}}}, "rise");
  refused({{{kNan, 0}}}, "finite");
  refused({{{1, 0}, {2, kInfinity}}}, "entry 1");
}

}  // namespace
}  // namespace viewgain
