// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "expect_error.hpp"

namespace viewgain {
namespace {

using test::expect_error;

void expect_looks_at(const Pose& pose, const Eigen::Vector3d& center, double radius) {
  ASSERT_LE(orthonormality_error(pose), 1e-15);
  const Eigen::Vector3d seen = pose.inverse() * center;
  ASSERT_NEAR(seen.x(), 0, 1e-14);
  ASSERT_NEAR(seen.y(), 0, 1e-14);
  ASSERT_NEAR(seen.z(), radius, 1e-14);
  ASSERT_GE(-pose.rotation()(2, 1), -1e-15);  // image-up does not point below the horizon
}

TEST(SpherePoses, AreTheFibonacciLattice) {
  const Eigen::Vector3d center(0.1, -0.2, 0.3);
  int cases = 0;
  for (const std::size_t n : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{2000}}) {
    const auto poses = sphere_poses(n, 0.6, center);
    ASSERT_EQ(poses.size(), n);
    for (std::size_t i = 0; i < n; ++i, ++cases) {
      const double index = static_cast<double>(i), count = static_cast<double>(n);
      const Eigen::Vector3d offset = (poses[i].translation() - center) / 0.6;
      ASSERT_NEAR(offset.z(), 1 - (2 * index + 1) / count, 1e-14);
      const double turns = index * (3 - std::sqrt(5.0)) / 2;  // azimuth / 2π
      const double azimuth = 2 * std::numbers::pi * (turns - std::floor(turns));
      const double ring = std::hypot(offset.x(), offset.y());
      ASSERT_NEAR(offset.x(), ring * std::cos(azimuth), 1e-11);
      ASSERT_NEAR(offset.y(), ring * std::sin(azimuth), 1e-11);
      expect_looks_at(poses[i], center, 0.6);
    }
  }
  EXPECT_EQ(cases, 2010);
}

TEST(SpherePoses, AreSpreadEvenly) {
  const auto poses = sphere_poses(1000, 1.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double nearest = 4;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    sum += poses[i].translation();
    for (std::size_t k = 0; k < i; ++k) {
      nearest = std::min(nearest, (poses[i].translation() - poses[k].translation()).norm());
    }
  }
  EXPECT_LT(sum.norm() / 1000, 1e-3);
  EXPECT_GT(nearest, 0.08);  // a hexagonal packing of 1000 points would have 0.12
}

TEST(DomePoses, AreTheUpperHalf) {
  const auto poses = dome_poses(500, 0.6);
  const auto sphere = sphere_poses(1000, 0.6);
  ASSERT_EQ(poses.size(), 500U);
  int cases = 0;
  for (std::size_t i = 0; i < 500; ++i, ++cases) {
    ASSERT_EQ(poses[i], sphere[i]);
    ASSERT_GT(poses[i].translation().z(), 0);
  }
  EXPECT_EQ(cases, 500);
}

TEST(OrbitPoses, LieOnACircleOfLatitude) {
  const double degree = std::numbers::pi / 180;
  const Eigen::Vector3d center(1, 2, 3);
  const auto poses = orbit_poses(3, 0.6, 27 * degree, 10 * degree, 46 * degree, center);
  ASSERT_EQ(poses.size(), 3U);
  int cases = 0;
  for (std::size_t i = 0; i < 3; ++i, ++cases) {
    const double azimuth = (10 + 46 * static_cast<double>(i)) * degree;
    const Eigen::Vector3d expected(std::cos(27 * degree) * std::cos(azimuth),
                                   std::cos(27 * degree) * std::sin(azimuth),
                                   std::sin(27 * degree));
    EXPECT_LT((poses[i].translation() - center - 0.6 * expected).norm(), 1e-15);
    expect_looks_at(poses[i], center, 0.6);
  }
  EXPECT_EQ(cases, 3);
}

TEST(OrbitPoses, StepDefaultsToAFullTurn) {
  const auto poses = orbit_poses(4, 2.0, 0.0);
  EXPECT_LT((poses[0].translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((poses[1].translation() - Eigen::Vector3d(0, 2, 0)).norm(), 1e-15);
  EXPECT_LT((poses[3].translation() - Eigen::Vector3d(0, -2, 0)).norm(), 1e-15);
}

TEST(OrbitPoses, OverThePoleImageUpIsPlusX) {
  const auto poses = orbit_poses(5, 1.0, std::numbers::pi / 2);
  int cases = 0;
  for (const Pose& pose : poses) {
    EXPECT_LT((pose.rotation().col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-15);
    ++cases;
  }
  EXPECT_EQ(cases, 5);
}

TEST(Generators, RefuseWhatMakesNoSense) {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const ErrorCode code = ErrorCode::invalid_argument;
  expect_error(code, "sphere: the number of poses is 0", [] { (void)sphere_poses(0, 1); });
  expect_error(code, "dome: the radius", [] { (void)dome_poses(3, -1); });
  expect_error(code, "radius", [] { (void)sphere_poses(3, 0); });
  expect_error(code, "radius", [] { (void)orbit_poses(3, kNan, 0); });
  expect_error(code, "centre", [] { (void)sphere_poses(3, 1, {0, kNan, 0}); });
  expect_error(code, "angle", [] { (void)orbit_poses(3, 1, kNan); });
  expect_error(code, "angle", [] { (void)orbit_poses(3, 1, 0, 0, kNan); });
  expect_error(ErrorCode::capacity, "most possible", [] { (void)sphere_poses(200'000'000, 1); });
}

}  // namespace
}  // namespace viewgain
