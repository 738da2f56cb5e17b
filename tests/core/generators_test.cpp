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

TEST(DomePoses, AreTheUpperHalf) {
  const auto poses = dome_poses(500, 0.6);
  const auto sphere = sphere_poses(1000, 0.6);
  ASSERT_EQ(poses.size(), 500U);
  for (std::size_t i = 0; i < 500; ++i) {
    ASSERT_EQ(poses[i], sphere[i]);
    ASSERT_GT(poses[i].translation().z(), 0);
  }
}

TEST(OrbitPoses, LieOnACircleOfLatitude) {
  const double degree = std::numbers::pi / 180;
  const Eigen::Vector3d center(1, 2, 3);
  const auto poses = orbit_poses(3, 0.6, 27 * degree, 10 * degree, 46 * degree, center);
  ASSERT_EQ(poses.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const double azimuth = (10 + 46 * static_cast<double>(i)) * degree;
    const Eigen::Vector3d expected(std::cos(27 * degree) * std::cos(azimuth),
                                   std::cos(27 * degree) * std::sin(azimuth),
                                   std::sin(27 * degree));
    EXPECT_LT((poses[i].translation() - center - 0.6 * expected).norm(), 1e-15);
    expect_looks_at(poses[i], center, 0.6);
  }
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

// Where a ring's pose is and how far down it looks, in cylinder coordinates round the centre.
struct RingPlace {
  double radius, height, tilt;  // [m], [m], [degrees]
};

RingPlace place_of(const Pose& pose, const Eigen::Vector3d& center) {
  EXPECT_LE(orthonormality_error(pose), 1e-15);
  const Eigen::Vector3d offset = pose.translation() - center;
  const Eigen::Vector3d forward = pose.rotation().col(2);
  const double radius = std::hypot(offset.x(), offset.y());
  // The axis and the view direction lie in one vertical plane; the image's rows are level.
  EXPECT_NEAR(offset.x() * forward.y() - offset.y() * forward.x(), 0, 1e-14);
  EXPECT_NEAR(pose.rotation()(2, 0), 0, 1e-15);
  const double inward = -(offset.x() * forward.x() + offset.y() * forward.y()) / radius;
  return {radius, offset.z(), std::atan2(-forward.z(), inward) * 180 / std::numbers::pi};
}

TEST(RingPoses, AreARingThatLooksDown) {
  const Eigen::Vector3d center(1, -2, 0.5);
  const double degree = std::numbers::pi / 180;
  for (const double tilt : {-30.0, 0.0, 22.5, 89.0}) {
    const auto poses = ring_poses(7, 0.6, 0.35, tilt * degree, 0.3, center);
    ASSERT_EQ(poses.size(), 7U);
    for (std::size_t i = 0; i < 7; ++i) {
      const RingPlace place = place_of(poses[i], center);
      EXPECT_NEAR(place.radius, 0.6, 1e-15);
      EXPECT_NEAR(place.height, 0.35, 1e-15);
      EXPECT_NEAR(place.tilt, tilt, 1e-12);
      const Eigen::Vector3d offset = poses[i].translation() - center;
      const double azimuth = 0.3 + 2 * std::numbers::pi * static_cast<double>(i) / 7;
      EXPECT_NEAR(
          std::remainder(std::atan2(offset.y(), offset.x()) - azimuth, 2 * std::numbers::pi), 0,
          1e-14);
      EXPECT_GE(-poses[i].rotation()(2, 1), 0);  // image-up does not point below the horizon
    }
  }
  EXPECT_EQ(ring_poses(1, 1, 0, 90 * degree)[0].rotation().col(2).z(), -1);
}

// Counts the poses of a set at each place; places that are not listed fail.
void expect_rings(std::size_t total, double radius, const std::vector<RingPlace>& rings) {
  const Eigen::Vector3d center(0.1, 0.2, -0.3);
  const auto poses = literature_ring_poses(total, radius, center);
  ASSERT_EQ(poses.size(), total);
  ASSERT_EQ(rings.size() * 16, total);
  std::vector<std::vector<double>> azimuths(rings.size());
  for (const Pose& pose : poses) {
    const RingPlace place = place_of(pose, center);
    const auto ring = std::find_if(rings.begin(), rings.end(), [&place](const RingPlace& r) {
      return std::abs(r.radius - place.radius) < 1e-12 &&
             std::abs(r.height - place.height) < 1e-12 && std::abs(r.tilt - place.tilt) < 1e-9;
    });
    ASSERT_NE(ring, rings.end()) << place.radius << " " << place.height << " " << place.tilt;
    const Eigen::Vector3d offset = pose.translation() - center;
    const double turn = std::atan2(offset.y(), offset.x()) / (2 * std::numbers::pi);
    azimuths[static_cast<std::size_t>(ring - rings.begin())].push_back(
        std::round(1e6 * (turn - std::floor(turn))) / 1e6);
  }
  int cases = 0;
  for (std::vector<double>& ring : azimuths) {
    std::sort(ring.begin(), ring.end());
    ASSERT_EQ(ring.size(), 16U);
    for (std::size_t i = 0; i < 16; ++i) ASSERT_EQ(ring[i], static_cast<double>(i) / 16);
    ++cases;
  }
  EXPECT_EQ(cases, static_cast<int>(rings.size()));
}

// The numbers are those of the published files, radius 0.6 m (48) or 0.5 m, in metres and degrees.
TEST(LiteratureRings, AreThePublishedSets) {
  expect_rings(48, 0.6,
               {{0.6, 0.15, 0}, {0.6, 0.35, 0}, {0.424264068711929, 0.774264068711929, 45}});
  const double s30 = 0.5, s60 = std::sqrt(0.75);
  expect_rings(80, 0.5,
               {{0.5, 0.15, 0},
                {0.5, 0.3, 0},
                {0.5, 0.45, 0},
                {0.5 * s60, 0.7, 30},
                {0.5 * s30, 0.45 + 0.5 * s60, 60}});
  const auto tilted = [&](double radius) {
    std::vector<RingPlace> rings;
    for (const double tilt : {-22.5, 0.0, 22.5}) {
      for (const double height : {0.1, 0.2, 0.3, 0.4}) rings.push_back({radius, height, tilt});
      rings.push_back({radius * s60, 0.4 + radius * s30, 30 + tilt});
      rings.push_back({radius * s30, 0.4 + radius * s60, 60 + tilt});
    }
    return rings;
  };
  expect_rings(288, 0.5, tilted(0.5));
  std::vector<RingPlace> three = tilted(0.4);
  for (const double radius : {0.6, 0.8}) {
    const auto more = tilted(radius);
    three.insert(three.end(), more.begin(), more.end());
  }
  expect_rings(864, 0.5, three);
  for (RingPlace& place : three) place = {3 * place.radius, 3 * place.height, place.tilt};
  expect_rings(864, 1.5, three);
}

TEST(ShellPoses, AreUniformInTheVolume) {
  const Eigen::Vector3d center(0.5, 0, -1);
  const double a = 0.4, b = 0.9;
  constexpr std::size_t kCount = 40'000;
  const auto poses = shell_poses(kCount, a, b, 5, center);
  ASSERT_EQ(poses.size(), kCount);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double mean_radius = 0;
  std::size_t cases = 0;
  for (const Pose& pose : poses) {
    const Eigen::Vector3d p = pose.translation() - center;
    const double r = p.norm();
    ASSERT_GE(r, a - 1e-15);
    ASSERT_LE(r, b + 1e-15);
    expect_looks_at(pose, center, r);
    mean += p / kCount;
    second += p * p.transpose() / kCount;
    mean_radius += r / kCount;
    ++cases;
  }
  EXPECT_EQ(cases, kCount);
  // E r^k = 3 / (k + 3) (b^(k+3) - a^(k+3)) / (b³ - a³); the directions are isotropic. Bounds of
  // five standard errors.
  const double volume = b * b * b - a * a * a;
  const double r1 = 0.75 * (std::pow(b, 4) - std::pow(a, 4)) / volume;
  const double r2 = 0.6 * (std::pow(b, 5) - std::pow(a, 5)) / volume;
  const double bound = 5 / std::sqrt(static_cast<double>(kCount));
  EXPECT_NEAR(mean_radius, r1, bound * std::sqrt(r2 - r1 * r1));
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), bound * std::sqrt(r2 / 3));
  EXPECT_LT((second - r2 / 3 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), bound * r2);
}

TEST(ShellPoses, DependOnTheSeedAlone) {
  const auto poses = shell_poses(100, 0.4, 0.9, 7);
  EXPECT_EQ(poses, shell_poses(100, 0.4, 0.9, 7));
  EXPECT_NE(poses, shell_poses(100, 0.4, 0.9, 8));
  const auto more = shell_poses(200, 0.4, 0.9, 7);
  EXPECT_TRUE(std::equal(poses.begin(), poses.end(), more.begin()));
  // From a transcription to Python; a machine or compiler that differs is seen.
  const Eigen::Vector3d first = shell_poses(1, 1.0, 2.0, 0)[0].translation();
  EXPECT_EQ(first.x(), -0x1.83c188ec9d5e6p+0);
  EXPECT_EQ(first.y(), -0x1.542cc083c406ep-1);
  EXPECT_EQ(first.z(), -0x1.cd23df007c51dp-1);
  int cases = 0;
  for (const Pose& pose : shell_poses(50, 0.7, 0.7, 3)) {  // a shell without thickness
    EXPECT_NEAR(pose.translation().norm(), 0.7, 1e-15);
    ++cases;
  }
  EXPECT_EQ(cases, 50);
}

TEST(Generators, RefuseWhatMakesNoSense) {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const ErrorCode code = ErrorCode::invalid_argument;
  expect_error(code, "sphere: the number of poses must be at least 1, not 0",
               [] { (void)sphere_poses(0, 1); });
  expect_error(code, "dome: the radius", [] { (void)dome_poses(3, -1); });
  expect_error(code, "radius", [] { (void)sphere_poses(3, 0); });
  expect_error(code, "radius", [] { (void)orbit_poses(3, kNan, 0); });
  expect_error(code, "centre", [] { (void)sphere_poses(3, 1, {0, kNan, 0}); });
  expect_error(code, "angle", [] { (void)orbit_poses(3, 1, kNan); });
  expect_error(code, "angle", [] { (void)orbit_poses(3, 1, 0, 0, kNan); });
  expect_error(code, "rings: the tilt must be finite", [] { (void)ring_poses(3, 1, 0, kNan); });
  expect_error(code, "height", [] { (void)ring_poses(3, 1, kNan, 0); });
  expect_error(code, "radius", [] { (void)ring_poses(3, 0, 1, 0); });
  expect_error(code, "48, 80, 288 or 864, not 64", [] { (void)literature_ring_poses(64, 1); });
  expect_error(code, "radius", [] { (void)literature_ring_poses(48, -1); });
  expect_error(code, "radius", [] { (void)shell_poses(3, 0, 1, 1); });
  expect_error(code, "minimum radius", [] { (void)shell_poses(3, 2, 1, 1); });
  expect_error(code, "number of poses must be at least 1, not 0",
               [] { (void)shell_poses(0, 1, 2, 1); });
  expect_error(ErrorCode::capacity, "the maximum is", [] { (void)sphere_poses(200'000'000, 1); });
}

}  // namespace
}  // namespace viewgain
