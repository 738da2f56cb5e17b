// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/pose_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/expect_error.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

const Pose kPose = look_at({0.3, -0.4, 0.2}, {0, 0, 0});

TEST(PoseNoise, TheFirstViewIsExact) {
  EXPECT_EQ(reported_pose(kPose, 0, {0.01, 0.1}, 3), kPose);
  EXPECT_EQ(reported_pose(kPose, 5, {0, 0}, 3), kPose);
}

TEST(PoseNoise, TheOthersAreOffByTheSigmasInEachPart) {
  constexpr std::size_t kViews = 4000;
  constexpr double kShift = 0.01, kTurn = 0.02;
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> squares = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t view = 1; view <= kViews; ++view) {
    const Pose pose = reported_pose(kPose, view, {kShift, kTurn}, 7);
    EXPECT_LT(orthonormality_error(pose), 1e-12);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation() * kPose.rotation().transpose()));
    Eigen::Matrix<double, 6, 1> d;
    d << (pose.translation() - kPose.translation()) / kShift, turn.angle() * turn.axis() / kTurn;
    sum += d;
    squares += d * d.transpose();
  }
  // Five standard errors.
  const double few = 5 / std::sqrt(static_cast<double>(kViews));
  EXPECT_LT((sum / kViews).cwiseAbs().maxCoeff(), few);
  EXPECT_LT((squares / kViews - Eigen::Matrix<double, 6, 6>::Identity()).cwiseAbs().maxCoeff(),
            std::sqrt(2.0) * few);
}

TEST(PoseNoise, SeedAndViewFixIt) {
  const PoseSigma sigma{0.01, 0.02};
  EXPECT_EQ(reported_pose(kPose, 3, sigma, 1), reported_pose(kPose, 3, sigma, 1));
  EXPECT_NE(reported_pose(kPose, 3, sigma, 1), reported_pose(kPose, 4, sigma, 1));
  EXPECT_NE(reported_pose(kPose, 3, sigma, 1), reported_pose(kPose, 3, sigma, 2));
}

TEST(PoseNoise, BadSigmasAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_error(ErrorCode::invalid_argument, "sigma_translation", [] {
    (void)reported_pose(kPose, 1, {-1, 0}, 1);
  });
  test::expect_error(ErrorCode::invalid_argument, "sigma_rotation", [&] {
    (void)reported_pose(kPose, 0, {0, nan}, 1);
  });
}

}  // namespace
}  // namespace viewgain
