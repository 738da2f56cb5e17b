// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which pooled points are delivered: thinning leaves no holes, and a further view none either.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "box_frames.hpp"
#include "core/random_values.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kVoxel = 0.005;        // [m]
const Vector3d kPost(0.02, 0.03, 0.1);  // half sides of a post [m]

Vector3d vector(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

// The post, seen from all around.
BeliefGrid post(int views) {
  const Sensor sensor = box_camera(0.002);
  BeliefGrid grid({kVoxel, {{-0.12, -0.12, -0.14}, {0.12, 0.12, 0.14}}, {}, 0.01});
  FrameIntegrator integrator(sensor);
  std::mt19937_64 random(11);
  for (int i = 0; i < views; ++i) {
    const double turn = 2.4 * i;
    const Pose pose = look_at({0.35 * std::cos(turn), 0.35 * std::sin(turn), 0.1 - 0.02 * (i % 9)},
                              {0, 0, 0}, {0, 0, 1});
    integrator.integrate(grid, see_box(sensor, pose, kPost, random), pose);
  }
  return grid;
}

double nearest(const std::vector<FusedPoint>& points, const Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const FusedPoint& point : points) {
    least = std::min(least, (vector(point.position) - p).norm());
  }
  return least;
}

// Whatever is as near to a pooled point as a voxel is nearly as near to one that stays.
TEST(PointSelection, ThinningLeavesNoHoles) {
  const BeliefGrid grid = post(8);
  FusedPointsConfig every;
  every.min_distance = 0;
  const std::vector<FusedPoint> all = fused_points(grid, every), thin = fused_points(grid);
  EXPECT_LT(thin.size(), all.size() * 3 / 4);
  RandomValues random(3);
  std::size_t looked = 0, beyond = 0;
  double farthest = 0;
  for (const FusedPoint& point : all) {
    const Vector3d n = vector(point.toward_free);
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    const double r = kVoxel * std::sqrt(random.uniform(0, 1));
    const Vector3d u = n.unitOrthogonal();
    const double d = nearest(
        thin, vector(point.position) + r * (std::cos(turn) * u + std::sin(turn) * n.cross(u)));
    farthest = std::max(farthest, d);
    if (d > kVoxel) ++beyond;
    ++looked;
  }
  EXPECT_GT(looked, 1500U);
  EXPECT_LE(beyond, 2U);  // between the directions in which rims are looked at
  EXPECT_LT(farthest, 1.05 * kVoxel);
}

// A further view un-covers hardly anything that was covered.
TEST(PointSelection, AFurtherViewLeavesWhatWasCovered) {
  std::vector<Vector3d> samples;
  for (double z = -0.095; z < 0.096; z += 0.002) {
    for (double t = -0.95; t < 0.96; t += 0.05) {
      for (const double side : {-1.0, 1.0}) {
        samples.emplace_back(side * kPost.x(), t * kPost.y(), z);
        samples.emplace_back(t * kPost.x(), side * kPost.y(), z);
      }
    }
  }
  std::vector<bool> was(samples.size());
  std::size_t covered = 0, lost = 0;
  for (int views = 4; views <= 10; ++views) {
    const std::vector<FusedPoint> points = fused_points(post(views));
    for (std::size_t i = 0; i < samples.size(); i += 7) {
      const bool is = nearest(points, samples[i]) <= kVoxel;
      if (views > 4 && was[i]) {
        ++covered;
        if (!is) ++lost;
      }
      was[i] = is;
    }
  }
  EXPECT_GT(covered, 8000U);
  EXPECT_LT(static_cast<double>(lost), 0.004 * static_cast<double>(covered));
}

}  // namespace
}  // namespace viewgain
