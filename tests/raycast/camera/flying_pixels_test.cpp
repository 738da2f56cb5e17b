// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// How many flying pixels the jump-edge filter finds on the camel, and what it costs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <vector>

#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGoodExtent = 0.02;  ///< of the ranges in a pixel that sees one surface [m]
constexpr double kObjectRange = 0.9;  ///< the camel is nearer, the background farther [m]

struct Counts {
  std::uint64_t all = 0, removed = 0;
  [[nodiscard]] double share() const {
    return static_cast<double>(removed) / static_cast<double>(all);
  }
  void add(bool is_removed) {
    ++all;
    removed += is_removed ? 1 : 0;
  }
};

/// Readings by what their rays truly met. Good: one surface. Flying: more, and more than 3 sigma
/// from all of them. Outliers: more than 3 sigma, of one surface too, where it is noise alone.
struct Judged {
  Counts flying, outliers, good_object, good_background;

  void add(const Sensor& sensor, const std::vector<Eigen::Vector3d>& rays, const DepthFrame& frame,
           const DepthFrame& filtered, const std::vector<SimulatedSensor::PixelTruth>& truth) {
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      if (!(frame.depth[i] > 0) || !std::isfinite(frame.depth[i])) continue;
      const double range = frame.depth[i] * rays[i].norm();
      const double cosine = std::min(1.0, frame.amplitude[i] * range * range);
      const bool removed = filtered.depth[i] == DepthFrame::kInvalid;
      const bool good = truth[i].max_range - truth[i].min_range <= kGoodExtent;
      if (good) (truth[i].max_range < kObjectRange ? good_object : good_background).add(removed);
      if (std::abs(range - truth[i].nearest_range) > 3 * sensor.sigmas(range, cosine).axial) {
        outliers.add(removed);
        if (!good) flying.add(removed);
      }
    }
  }
};

void print(const char* name, const Counts& counts) {
  std::printf(", %s %llu: %.2f %%", name, static_cast<unsigned long long>(counts.all),
              100 * counts.share());
}

struct Comparison {
  Judged nearer, two_sided;
};

void print(const char* filter, bool lateral_noise, const Judged& judged) {
  std::printf("removed by the %s filter, lateral noise %s", filter, lateral_noise ? "on" : "off");
  print("flying", judged.flying);
  print("all beyond 3 sigma", judged.outliers);
  print("good on the object", judged.good_object);
  print("good behind it", judged.good_background);
  std::printf("\n");
}

// The camel at 0.45 m, six poses, seeds 1 to 5.
Comparison compare(bool lateral_noise) {
  const Sensor sensor = sensor_preset("sr4000");
  const auto rays = sensor.camera.ray_table();
  const JumpEdgeFilter nearer(sensor.camera), two_sided(sensor.camera, {.two_sided = true});
  const auto scene = std::make_shared<const SurfaceScene>(test::camel_mesh());
  Comparison result;
  std::vector<SimulatedSensor::PixelTruth> truth;
  int frames = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SimulatedSensor camera(scene, sensor,
                                 {.background_radius = 1.5,
                                  .noise = true,
                                  .seed = seed,
                                  .sub_rays = 3,
                                  .lateral_noise = lateral_noise});
    std::uint64_t index = 0;
    for (const Pose& pose : orbit_poses(6, 0.45, 27 * kDegree)) {
      const DepthFrame frame = camera.acquire(pose, index++, truth);
      DepthFrame filtered = frame;
      nearer.apply(filtered);
      result.nearer.add(sensor, rays, frame, filtered, truth);
      filtered = frame;
      two_sided.apply(filtered);
      result.two_sided.add(sensor, rays, frame, filtered, truth);
      ++frames;
    }
  }
  EXPECT_EQ(frames, 30);
  print("nearer-neighbour", lateral_noise, result.nearer);
  print("two-sided", lateral_noise, result.two_sided);
  return result;
}

TEST(FlyingPixels, TheFilterFindsThemAndKeepsTheObject) {
  const auto [nearer, two_sided] = compare(false);
  EXPECT_GT(nearer.flying.all, 10'000U);
  EXPECT_GT(nearer.good_object.all, 200'000U);
  EXPECT_GE(nearer.flying.share(), 0.98);
  EXPECT_GE(nearer.outliers.share(), 0.90);
  EXPECT_LE(nearer.good_object.share(), 0.03);
  // What lies behind a jump goes with it: the filter takes the far side of every edge.
  EXPECT_LE(nearer.good_background.share(), 0.08);

  EXPECT_GE(two_sided.flying.share(), nearer.flying.share());
  EXPECT_GT(two_sided.good_object.share(), 3 * nearer.good_object.share());
}

TEST(FlyingPixels, StillFoundWithLateralNoise) {
  const auto [nearer, two_sided] = compare(true);
  EXPECT_GE(nearer.flying.share(), 0.90);
  EXPECT_LE(nearer.good_object.share(), 0.05);
  EXPECT_GT(two_sided.good_object.share(), 3 * nearer.good_object.share());
}

}  // namespace
}  // namespace viewgain
