// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/range_calibration.hpp"

#include <gtest/gtest.h>

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
  const PinholeCamera camera{2, 1, 1.0, 1.0, 0.0, 0.0, {}};
  DepthFrame frame{2, 1, {0.01F, 1.F}};
  const DepthFrame before = frame;
  none.correct(camera, frame);
  EXPECT_EQ(frame, before);
  frame.width = 3;
  expect_error(ErrorCode::invalid_argument, "3", [&] { none.correct(camera, frame); });
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
