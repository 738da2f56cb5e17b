// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <type_traits>

#include "expect_error.hpp"
#include "random_values.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::RandomValues;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double largest_difference(const Pose& a, const Pose& b) {
  double largest = 0;
  for (std::size_t i = 0; i < 12; ++i) largest = std::max(largest, std::abs(a.m[i] - b.m[i]));
  return largest;
}

TEST(Pose, IsPlain) {
  static_assert(std::is_trivially_copyable_v<Pose> && std::is_standard_layout_v<Pose>);
  EXPECT_EQ(sizeof(Pose), 96U);
  EXPECT_EQ(Pose().isometry().matrix(), Eigen::Matrix4d::Identity());
}

TEST(Pose, ConvertsFromAndToEigenExactly) {
  RandomValues random(1);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = random.rotation();
    T.translation() = 10 * random.vector();
    const Pose pose = T;
    ASSERT_EQ(pose.isometry().matrix(), T.matrix());
    ASSERT_EQ(pose, Pose(T.linear(), T.translation()));
    ASSERT_EQ(pose.m[7], T.translation().y());
    ASSERT_EQ(pose.m[6], T.linear()(1, 2));
  }
}

TEST(Pose, ComposesAndInvertsAsEigen) {
  RandomValues random(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose a(random.rotation(), random.vector());
    const Pose b(random.rotation(), random.vector());
    const Eigen::Vector3d p = random.vector();
    ASSERT_LT(largest_difference(a * b, Pose(a.isometry() * b.isometry())), 1e-14);
    ASSERT_LT(((a * b) * p - a * (b * p)).norm(), 1e-14);
    ASSERT_LT(largest_difference(a * a.inverse(), Pose()), 1e-14);
    ASSERT_LT(largest_difference(a.inverse(), Pose(a.isometry().inverse())), 1e-14);
  }
}

TEST(Orthonormality, MeasuresTheLargestEntry) {
  RandomValues random(3);
  EXPECT_EQ(orthonormality_error(Pose()), 0.0);
  EXPECT_LT(orthonormality_error({random.rotation(), random.vector()}), 1e-15);
  EXPECT_NEAR(orthonormality_error({1.01 * Eigen::Matrix3d::Identity(), {0, 0, 0}}), 0.0201, 1e-12);
  EXPECT_EQ(orthonormality_error({-Eigen::Matrix3d::Identity(), {0, 0, 0}}), kInfinity);
  EXPECT_EQ(orthonormality_error({Eigen::Matrix3d::Zero(), {0, 0, 0}}), kInfinity);
  for (std::size_t i = 0; i < 12; ++i) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      Pose pose;
      pose.m[i] = bad;
      EXPECT_EQ(orthonormality_error(pose), kInfinity) << i;
    }
  }
}

TEST(Orthonormality, MendsToTheNearestRotation) {
  RandomValues random(4);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Matrix3d R = random.rotation();
    Eigen::Matrix3d off = R;
    for (int k = 0; k < 9; ++k) off(k) += random.uniform(-5e-3, 5e-3);
    const Pose mended = orthonormalized({off, {1, 2, 3}});
    ASSERT_LE(orthonormality_error(mended), 4e-15);
    ASSERT_EQ(mended.translation(), Eigen::Vector3d(1, 2, 3));
    const double distance = (mended.rotation() - off).norm();
    for (int k = 0; k < 20; ++k) {
      const Eigen::AngleAxisd turn(random.magnitude(1e-5, 0.1), random.unit_vector());
      ASSERT_GE((turn.toRotationMatrix() * mended.rotation() - off).norm(), distance);
    }
  }
}

TEST(Orthonormality, AReflectionBecomesARotation) {
  const Pose mended = orthonormalized({Eigen::Vector3d(1, 1, -1).asDiagonal(), {0, 0, 0}});
  EXPECT_LE(orthonormality_error(mended), 1e-15);
}

TEST(Orthonormality, LeavesWhatIsNotFinite) {
  Pose pose;
  pose.m[4] = kInfinity;
  EXPECT_EQ(orthonormalized(pose), pose);
}

TEST(Orthonormality, APoseIsRigidAsItIsOrMendedOrNotAtAll) {
  RandomValues random(6);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d R = random.rotation();
    const auto off_by = [&](double error) { return Pose{(1 + 0.5 * error) * R, {1, 2, 3}}; };
    EXPECT_EQ(rigid_pose(off_by(5e-10)), off_by(5e-10));
    EXPECT_EQ(rigid_pose(off_by(5e-9)), orthonormalized(off_by(5e-9)));
    EXPECT_EQ(rigid_pose(off_by(0.99e-3)), orthonormalized(off_by(0.99e-3)));
    EXPECT_EQ(rigid_pose(off_by(1.01e-3)), std::nullopt);
  }
  EXPECT_EQ(rigid_pose({Eigen::Matrix3d::Identity(), {0, kInfinity, 0}}), std::nullopt);
}

// The camera's frame, derived without cross products: z towards the target, image-up the part of
// `up` that is left across z.
void expect_looks(const Pose& pose, const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                  const Eigen::Vector3d& up, double tolerance) {
  const Eigen::Matrix3d R = pose.rotation();
  ASSERT_LE(orthonormality_error(pose), 1e-15);
  ASSERT_EQ(pose.translation(), eye);
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d image_up = (up - z * z.dot(up)).normalized();
  ASSERT_LT((R.col(2) - z).norm(), 1e-15);
  ASSERT_LT((-R.col(1) - image_up).norm(), tolerance);
}

TEST(LookAt, PointsTheAxisAndKeepsUpUp) {
  RandomValues random(5);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d eye = random.vector(), target = random.vector(), up = random.vector();
    expect_looks(look_at(eye, target, up), eye, target, up, 1e-10);
    const Pose pose = look_at(eye, target);
    expect_looks(pose, eye, target, Eigen::Vector3d::UnitZ(), 1e-10);
    ASSERT_LT(std::abs(pose.rotation()(2, 0)), 1e-12);  // the image's rows are level
    const Eigen::Vector3d seen = pose.inverse() * target;
    ASSERT_LT(seen.head<2>().norm(), 1e-14 * (1 + eye.norm() + target.norm()));
    ASSERT_GT(seen.z(), 0);
  }
}

TEST(LookAt, AtThePolesImageUpIsPlusX) {
  for (const double z : {2.0, -2.0}) {
    const Eigen::Matrix3d R = look_at({0, 0, z}, {0, 0, 0}).rotation();
    EXPECT_EQ(R.col(2), Eigen::Vector3d(0, 0, z > 0 ? -1 : 1));
    EXPECT_EQ(R.col(1), Eigen::Vector3d(-1, 0, 0));
  }
  // Along world x with up along x, +x cannot help.
  EXPECT_EQ(look_at({1, 0, 0}, {0, 0, 0}, {1, 0, 0}).rotation().col(1), Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(look_at({1, 0, 0}, {0, 0, 0}, {-5, 0, 0}).rotation().col(1), Eigen::Vector3d(0, -1, 0));
}

TEST(LookAt, StaysOrthonormalNearThePoles) {
  for (int exponent = 1; exponent <= 20; ++exponent) {
    for (int azimuth = 0; azimuth < 50; ++azimuth) {
      const double s = std::pow(10.0, -exponent);
      const Pose pose = look_at({s * std::cos(azimuth), s * std::sin(azimuth), 1}, {0, 0, 0});
      ASSERT_LE(orthonormality_error(pose), 1e-15) << exponent << " " << azimuth;
      // Under a sine of 1e-8 the direction is the pole's.
      if (exponent > 8) {
        ASSERT_LT((pose.rotation().col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-7);
      }
    }
  }
}

TEST(LookAt, DoesNotMindTheScale) {
  RandomValues random(6);
  for (const double scale : {1e-300, 1e-160, 1e-30, 1e30, 1e160, 1e300}) {
    const Eigen::Vector3d eye = random.vector(), target = random.vector(), up = random.vector();
    const Pose reference = look_at(eye, target, up);
    const Pose scaled = look_at(scale * eye, scale * target, scale * up);
    EXPECT_LT((reference.rotation() - scaled.rotation()).norm(), 1e-14) << scale;
  }
}

TEST(LookAt, RefusesWhatHasNoAnswer) {
  const ErrorCode code = ErrorCode::invalid_argument;
  expect_error(code, "same point", [] { (void)look_at({1, 2, 3}, {1, 2, 3}); });
  expect_error(code, "up must not be zero", [] { (void)look_at({1, 2, 3}, {0, 0, 0}, {0, 0, 0}); });
  expect_error(code, "must be finite", [] { (void)look_at({kNan, 2, 3}, {1, 2, 3}); });
  expect_error(code, "must be finite", [] { (void)look_at({1, 2, 3}, {1, kInfinity, 3}); });
  expect_error(code, "must be finite", [] { (void)look_at({1, 2, 3}, {0, 0, 0}, {0, 0, kNan}); });
  expect_error(code, "too far", [] { (void)look_at({1e308, 0, 0}, {-1e308, 0, 0}); });
}

}  // namespace
}  // namespace viewgain
