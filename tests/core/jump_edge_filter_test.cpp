// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/jump_edge_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "expect_error.hpp"
#include "random_values.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::RandomValues;

constexpr double kDegree = std::numbers::pi / 180;

PinholeCamera small_camera(int width, int height) {
  return {.width = width,
          .height = height,
          .fx = 220,
          .fy = 230,
          .cx = 0.5 * (width - 1),
          .cy = 0.5 * (height - 1),
          .distortion = {}};
}

DepthFrame flat(const PinholeCamera& camera, float depth) {
  const auto count =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  return {camera.width, camera.height, std::vector<float>(count, depth),
          std::vector<float>(count, 2.0F)};
}

/// The definition, by the angle itself.
DepthFrame filtered_by_definition(const PinholeCamera& camera, const JumpEdgeFilter::Config& config,
                                  const DepthFrame& frame, std::size_t& removed) {
  DepthFrame result = frame;
  removed = 0;
  const auto point = [&](int u, int v) -> Eigen::Vector3d {
    return static_cast<double>(frame.at(u, v)) * camera.ray(u, v);
  };
  const auto is_reading = [&](int u, int v) {
    return u >= 0 && v >= 0 && u < camera.width && v < camera.height && frame.at(u, v) > 0 &&
           std::isfinite(frame.at(u, v)) && camera.ray(u, v).allFinite();
  };
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (!is_reading(u, v)) continue;
      const Eigen::Vector3d p = point(u, v);
      bool flying = false;
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          if ((du == 0 && dv == 0) || !is_reading(u + du, v + dv)) continue;
          const Eigen::Vector3d q = point(u + du, v + dv);
          if (!config.two_sided && q.norm() >= p.norm()) continue;
          const double c = (q - p).normalized().dot(p.normalized());
          flying = flying || std::acos(std::min(1.0, std::abs(c))) < config.angle;
        }
      }
      if (!flying) continue;
      const auto i = static_cast<std::size_t>(v * camera.width + u);
      result.depth[i] = DepthFrame::kInvalid;
      result.amplitude[i] = 0;
      ++removed;
    }
  }
  return result;
}

TEST(JumpEdgeFilter, EqualsItsDefinition) {
  RandomValues random(4);
  std::size_t total = 0;
  for (int i = 0; i < 60; ++i) {
    // More rows than a thread takes at a time, in some cases.
    PinholeCamera camera = small_camera(17, i % 5 == 0 ? 45 : 13);
    if (i % 3 == 1) camera.distortion = {-0.2, 0.05, 0.001, -0.001, 0};
    if (i % 3 == 2) {  // a lens model that folds inside the image
      camera.fx = camera.fy = 9;
      camera.distortion = {-0.35, 0, 0, 0, 0};
    }
    if (i % 12 == 6) camera.fx = camera.fy = 0.7;  // neighbouring rays more than 30° apart
    if (i % 10 == 3) camera.width = 1, camera.cx = 0;
    if (i % 10 == 8) camera.height = 1, camera.cy = 0;
    const JumpEdgeFilter::Config config{random.uniform(1, 10) * kDegree, i % 2 == 0};
    DepthFrame frame = flat(camera, 1.0F);
    for (float& depth : frame.depth) {
      depth = static_cast<float>(random.uniform(0.97, 1.03));
      const double dice = random.uniform(0, 1);
      if (dice < 0.05) depth = DepthFrame::kInvalid;
      if (dice > 0.95) depth = DepthFrame::kOutOfRange;
      if (dice > 0.5 && dice < 0.55) depth = std::numeric_limits<float>::quiet_NaN();
      if (dice > 0.6 && dice < 0.65) depth = 1.5F;
      if (dice > 0.7 && dice < 0.71) depth = std::numeric_limits<float>::max();
    }
    std::size_t expected_removed = 0;
    const DepthFrame expected = filtered_by_definition(camera, config, frame, expected_removed);
    DepthFrame result = frame;
    const JumpEdgeFilter filter(camera, config, {.num_threads = 1 + i % 4});
    EXPECT_EQ(filter.apply(result), expected_removed);
    for (std::size_t k = 0; k < frame.depth.size(); ++k) {
      if (std::isnan(frame.depth[k])) {
        EXPECT_TRUE(std::isnan(result.depth[k]));
      } else {
        EXPECT_EQ(result.depth[k], expected.depth[k]) << i << " " << k;
      }
    }
    EXPECT_EQ(result.amplitude, expected.amplitude);
    total += expected_removed;
  }
  EXPECT_GT(total, 1000U);
}

TEST(JumpEdgeFilter, LeavesALonelyPixelAlone) {
  const PinholeCamera one = small_camera(1, 1);
  DepthFrame pixel = flat(one, 0.5F);
  EXPECT_EQ(JumpEdgeFilter(one).apply(pixel), 0U);
}

TEST(JumpEdgeFilter, RefusesBadArguments) {
  const PinholeCamera camera = small_camera(4, 3);
  for (const double degrees : {0.0, 0.99, 10.01, -5.0, std::nan("")}) {
    expect_error(ErrorCode::invalid_argument, "angle",
                 [&] { JumpEdgeFilter(camera, {.angle = degrees * kDegree}); });
  }
  EXPECT_NO_THROW(JumpEdgeFilter(camera, {.angle = 1 * kDegree}));
  EXPECT_NO_THROW(JumpEdgeFilter(camera, {.angle = 10 * kDegree}));
  expect_error(ErrorCode::invalid_argument, "width", [] { JumpEdgeFilter(small_camera(0, 3)); });
  const JumpEdgeFilter filter(camera);
  DepthFrame other = flat(small_camera(3, 4), 1.0F);
  expect_error(ErrorCode::invalid_argument, "3 x 4", [&] { filter.apply(other); });
  DepthFrame short_amplitude = flat(camera, 1.0F);
  short_amplitude.amplitude.pop_back();
  expect_error(ErrorCode::invalid_argument, "11 amplitudes",
               [&] { filter.apply(short_amplitude); });
  DepthFrame without = flat(camera, 1.0F);
  without.amplitude.clear();
  EXPECT_EQ(filter.apply(without), 0U);
}

}  // namespace
}  // namespace viewgain
