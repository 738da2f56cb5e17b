// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/range_calibration.hpp"

namespace viewgain {
namespace {

using test::expect_error;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

const RangeCalibration kTable{{{1.0, 0.01}, {2.0, 0.03}, {4.0, -0.05}}};

DepthFrame frame_of(const PinholeCamera& camera) {
  DepthFrame frame{camera.width, camera.height, {}};
  for (int i = 0; i < camera.width * camera.height; ++i) {
    frame.depth.push_back(0.4F + 0.0137F * static_cast<float>(i % 367));
  }
  return frame;
}

// Of each pixel, by its own ray.
float expected_of(const PinholeCamera& camera, const RangeCalibration& table, int u, int v,
                  float depth) {
  const double range_per_depth = camera.ray(u, v).norm();
  if (!(depth > 0) || !std::isfinite(depth) || !std::isfinite(range_per_depth)) return depth;
  const double range = table.corrected(depth * range_per_depth);
  return range > 0 ? static_cast<float>(range / range_per_depth) : DepthFrame::kInvalid;
}

void expect_same_bits(float is, float expected) {
  EXPECT_EQ(std::bit_cast<std::uint32_t>(is), std::bit_cast<std::uint32_t>(expected));
}

TEST(RangeCorrector, EveryPixelIsCorrectedAlongItsRay) {
  PinholeCamera camera{41, 29, 30.0, 31.0, 19.5, 14.25, {}};
  const std::vector<std::array<double, 5>> lenses{
      {}, {-0.1, 0.02, 0.001, -0.002, 0.003}, {-1.2, 0, 0, 0, 0}};
  int corrected = 0, without_ray = 0;
  for (const auto& lens : lenses) {
    camera.distortion = lens;
    DepthFrame frame = frame_of(camera);
    const std::size_t middle = 14 * 41 + 19;  // where all have a ray
    frame.depth[middle] = DepthFrame::kInvalid;
    frame.depth[middle + 1] = DepthFrame::kOutOfRange;
    frame.depth[middle + 2] = kNan;
    frame.depth[middle + 3] = -1.F;
    frame.depth[middle + 4] = 0.001F;  // less than its error
    frame.amplitude.assign(frame.depth.size(), 2.F);
    frame.known_depth.assign(frame.depth.size(), 1.F);
    const DepthFrame before = frame;
    const RangeCorrector corrector(camera, kTable);
    EXPECT_EQ(corrector.camera(), camera);
    EXPECT_EQ(corrector.calibration(), kTable);
    corrector.correct(frame);
    EXPECT_EQ(frame.amplitude, before.amplitude);
    EXPECT_EQ(frame.known_depth, before.known_depth);
    EXPECT_EQ(frame.depth[middle + 4], DepthFrame::kInvalid);
    DepthFrame at_once = before;
    kTable.correct(camera, at_once);
    std::vector<float> depths = before.depth;
    corrector.correct(depths);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const auto i = static_cast<std::size_t>(v * camera.width + u);
        const float expected = expected_of(camera, kTable, u, v, before.depth[i]);
        expect_same_bits(frame.depth[i], expected);
        expect_same_bits(at_once.depth[i], expected);
        expect_same_bits(depths[i], expected);
        if (std::isfinite(camera.ray(u, v).x())) {
          ++corrected;
        } else {
          ++without_ray;
        }
      }
    }
  }
  EXPECT_EQ(corrected + without_ray, 3 * 41 * 29);
  EXPECT_GT(corrected, 2 * 41 * 29);
  EXPECT_GT(without_ray, 100);  // the last lens folds
}

TEST(RangeCorrector, ManyThreadsMayUseOne) {
  const PinholeCamera camera{41, 29, 30.0, 31.0, 19.5, 14.25, {-0.1, 0, 0, 0, 0}};
  const RangeCorrector corrector(camera, kTable);
  DepthFrame expected = frame_of(camera);
  corrector.correct(expected);
  std::vector<DepthFrame> frames(4, frame_of(camera));
  {
    std::vector<std::jthread> threads;
    for (DepthFrame& frame : frames) threads.emplace_back([&] { corrector.correct(frame); });
  }
  for (const DepthFrame& frame : frames) EXPECT_EQ(frame, expected);
}

TEST(RangeCorrector, RefusesWhatCannotBe) {
  const PinholeCamera camera{7, 5, 4.0, 5.0, 2.5, 2.25, {}};
  const auto refused = [](const PinholeCamera& of, const RangeCalibration& table,
                          const char* word) {
    expect_error(ErrorCode::invalid_argument, word, [&] { (void)RangeCorrector(of, table); });
  };
  PinholeCamera bad = camera;
  bad.fx = -3;
  refused(bad, kTable, "fx");
  refused(bad, {}, "fx");
  refused(camera, {{{1, 0}, {1, 0}}}, "must increase");
  refused(camera, {{{1, 0}, {2, std::nan("")}}}, "entry 1");

  for (const RangeCalibration& table : {kTable, RangeCalibration{}}) {
    const RangeCorrector corrector(camera, table);
    DepthFrame turned{5, 7, std::vector<float>(35, 1.F)};
    expect_error(ErrorCode::invalid_argument, "5 x 7", [&] { corrector.correct(turned); });
    DepthFrame few{7, 5, std::vector<float>(34, 1.F)};
    expect_error(ErrorCode::invalid_argument, "34", [&] { corrector.correct(few); });
    expect_error(ErrorCode::invalid_argument, "34 depths, but the camera has 7 x 5 pixels",
                 [&] { corrector.correct(few.depth); });
    EXPECT_EQ(few.depth, std::vector<float>(34, 1.F));
    DepthFrame dim{7, 5, std::vector<float>(35, 1.F), {1.F}};
    expect_error(ErrorCode::invalid_argument, "amplitudes", [&] { corrector.correct(dim); });
  }
}

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
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto refused = [](const RangeCalibration& table, const char* word) {
    expect_error(ErrorCode::invalid_argument, word, [&] { table.validate(); });
  };
  refused({{{1, 0}, {1, 0}}}, "must increase");
  refused({{{1, 0}, {2, 0}, {1.5, 0}}}, "must increase");
  refused({{{kNan, 0}}}, "finite");
  refused({{{1, 0}, {2, kInfinity}}}, "entry 1");
}

}  // namespace
}  // namespace viewgain
