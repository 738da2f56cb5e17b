// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/frame_displacement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "grid/analytic_frames.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"

namespace viewgain {
namespace {

constexpr double kNoise = 0.002;  // [m]

PinholeCamera camera_with(double k1) {
  PinholeCamera camera{88, 72, 100, 104, 43, 36};
  camera.distortion[0] = k1;
  return camera;
}

// Of the plane m · p = 1.
DepthFrame see(const PinholeCamera& camera, const Eigen::Vector3d& m) {
  DepthFrame frame{camera.width, camera.height, {}};
  for (const Eigen::Vector3d& ray : camera.ray_table()) {
    frame.depth.push_back(static_cast<float>(1 / m.dot(ray)));
  }
  return frame;
}

TEST(PlaneAt, FindsThePlaneThatIsSeen) {
  std::size_t cases = 0;
  for (const double k1 : {0.0, -0.15}) {
    const PinholeCamera camera = camera_with(k1);
    const auto rays = camera.ray_table();
    for (const Eigen::Vector3d& m :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.4, -0.2, 1.3), Eigen::Vector3d(-1, 1, 2)}) {
      const DepthFrame frame = see(camera, m);
      for (const std::size_t u : {5U, 43U, 80U}) {
        const auto found = plane_at(frame, camera, rays, u, 40, kNoise);
        ASSERT_TRUE(found) << u;
        EXPECT_LT((*found - m).norm(), 2e-3 * m.norm()) << u << " " << k1;  // straight in a square
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 18U);
}

// The middle of a square on a ball lies on it, not behind it as the mean of the square does.
TEST(PlaneAt, CurvedSurfacesAreNotBehindThemselves) {
  std::size_t cases = 0;
  for (const double f : {90.0, 176.0, 525.0}) {
    PinholeCamera camera{88, 72, f, f, 43, 36};
    const auto rays = camera.ray_table();
    for (const double radius : {0.05, 0.1}) {
      DepthFrame frame{camera.width, camera.height, {}};
      for (const Eigen::Vector3d& ray : rays) {  // the near side of a ball 1 m away
        const double b = ray.z(), a = ray.squaredNorm(), c = 1 - radius * radius;
        const double root = b * b - a * c;
        frame.depth.push_back(root < 0 ? 0.0F : static_cast<float>((b - std::sqrt(root)) / a));
      }
      const auto found = plane_at(frame, camera, rays, 43, 36, kNoise);
      ASSERT_TRUE(found) << f << " " << radius;
      const Eigen::Vector3d p = static_cast<double>(frame.at(43, 36)) * rays[36 * 88 + 43];
      const double distance = (found->dot(p) - 1) / found->norm();
      EXPECT_LT(std::abs(distance), 2e-4) << f << " " << radius;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 6U);
}

TEST(PlaneAt, WhatIsNoPlaneIsNothing) {
  const PinholeCamera camera = camera_with(0);
  const auto rays = camera.ray_table();
  const DepthFrame wall = see(camera, {0, 0, 1});
  const auto found = [&](const DepthFrame& frame, std::size_t u, std::size_t v) {
    return plane_at(frame, camera, rays, u, v, kNoise).has_value();
  };
  EXPECT_TRUE(found(wall, 40, 40));
  for (const auto& [u, v] : {std::pair{0U, 40U}, {87U, 40U}, {40U, 0U}, {40U, 71U}}) {
    EXPECT_FALSE(found(wall, u, v)) << u << " " << v;
  }
  for (const float missing :
       {DepthFrame::kInvalid, DepthFrame::kOutOfRange, std::numeric_limits<float>::quiet_NaN()}) {
    DepthFrame frame = wall;
    frame.depth[41 * 88 + 41] = missing;
    EXPECT_FALSE(found(frame, 40, 40)) << missing;
    EXPECT_TRUE(found(frame, 50, 40)) << missing;
  }
  DepthFrame edge = wall;
  for (std::size_t i = 0; i < edge.depth.size(); ++i) edge.depth[i] = i % 88 > 40 ? 1.1F : 1.0F;
  EXPECT_FALSE(found(edge, 40, 40));
  EXPECT_TRUE(found(edge, 30, 40));
}

// Readings on planes of all directions, and the distances by a small motion.
struct Readings {
  std::vector<Eigen::Vector3d> points{}, normals{};
  std::vector<double> distances{};
};

Readings moved(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation, double noise,
               std::size_t count, std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Readings all;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p(0.3 * normal(random), 0.3 * normal(random), 1);
    const Eigen::Vector3d n =
        Eigen::Vector3d(normal(random), normal(random), 2 + normal(random)).normalized();
    all.points.push_back(p);
    all.normals.push_back(n);
    all.distances.push_back(n.dot(rotation.cross(p) + translation) + noise * normal(random));
  }
  return all;
}

double displacement_of(const Readings& all) {
  DisplacementFit fit;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    fit.add(all.points[i], all.normals[i], all.distances[i], kNoise);
  }
  EXPECT_TRUE(fit.tells());
  EXPECT_EQ(fit.expected(), kNoise);
  return fit.displacement();
}

TEST(DisplacementFit, IsTheMotionAlongTheNormals) {
  const Eigen::Vector3d rotation(0.01, -0.02, 0.005), translation(0.004, -0.003, 0.01);
  const Readings exact = moved(rotation, translation, 0, 400);
  double squares = 0;
  for (const double distance : exact.distances) squares += distance * distance;
  const double rms = std::sqrt(squares / 400);
  EXPECT_GT(rms, 0.005);
  EXPECT_NEAR(displacement_of(exact), rms, 1e-3 * rms);  // noise is taken off that is not there
  EXPECT_NEAR(displacement_of(moved(rotation, translation, kNoise, 400)), rms, 0.1 * rms);
  // A fifth on other surfaces.
  Readings with_others = moved(rotation, translation, kNoise, 400);
  for (std::size_t i = 0; i < 400; i += 5) with_others.distances[i] = 0.04;
  EXPECT_NEAR(displacement_of(with_others), rms, 0.25 * rms);
}

// Noise alone moves a fit by sqrt(6 / count) of its standard deviation, which is taken off.
TEST(DisplacementFit, NoiseIsNoMotion) {
  std::size_t cases = 0;
  for (const std::size_t count : {60U, 200U, 600U}) {
    double squares = 0;
    constexpr std::uint64_t kSeeds = 20;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed, ++cases) {
      const double found = displacement_of(moved({0, 0, 0}, {0, 0, 0}, kNoise, count, seed));
      squares += found * found;
    }
    const double rms = std::sqrt(squares / kSeeds);
    EXPECT_LT(rms, 0.75 * kNoise * std::sqrt(6 / static_cast<double>(count))) << count;
  }
  EXPECT_EQ(cases, 60U);
  EXPECT_EQ(displacement_of(moved({0, 0, 0}, {0, 0, 0}, 0, 100)), 0.0);
}

// One wall holds three of six motions; noise in the normals does not make the others large.
TEST(DisplacementFit, WhatIsHardlyHeldDoesNotCount) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  DisplacementFit fit;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(0.02 * normal(random), 0.02 * normal(random), 1).normalized();
    fit.add({0.1 * (i % 10), 0.1 * (i / 10), 1}, n, 0.01 + 0.001 * normal(random), kNoise);
  }
  EXPECT_NEAR(fit.displacement(), 0.01, 5e-4);
}

TEST(DisplacementFit, FewReadingsTellNothing) {
  DisplacementFit fit;
  EXPECT_FALSE(fit.tells());
  for (int i = 0; i < 59; ++i) fit.add({0.1 * i, 0, 1}, {0, 0, 1}, 0.01, kNoise);
  EXPECT_FALSE(fit.tells());
  fit.add({0, 1, 1}, {0, 0, 1}, 0.01, kNoise);
  EXPECT_TRUE(fit.tells());
  EXPECT_EQ(fit.size(), 60U);
}

}  // namespace
}  // namespace viewgain
