// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Frames round known shapes from known poses, all but the first reported a little off.
#include "viewgain/planner/align_frames.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "apps/planner/registration_scene.hpp"
#include "core/expect_error.hpp"

namespace viewgain {
namespace {

using test::kDegree;

constexpr double kShift = 0.01, kTurn = kDegree;
constexpr PoseSigma kSigma{kShift, kTurn};

std::vector<Pose> ring(int count) {
  std::vector<Pose> views;
  for (int i = 0; i < count; ++i) {
    views.push_back(test::camera_at(i * 360.0 / count, i % 2 == 0 ? 20 : -20,
                                    test::RegistrationScene::kDistance));
  }
  return views;
}

Pose reported(const Pose& pose, std::size_t view) {
  return view == 0 ? pose : test::disturbed(pose, kShift, kTurn, view);
}

std::vector<Pose> poses_of(const FrameAlignment& frames) {
  std::vector<Pose> poses;
  for (const FrameRegistration& one : frames.registrations()) poses.push_back(one.T_world_camera);
  return poses;
}

TEST(AlignFrames, ARingClosesOnTheTruth) {
  for (const bool noise : {false, true}) {
    const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), noise, {});
    FrameAlignment frames = scene.alignment();
    const std::vector<Pose> truth = ring(8);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const FrameRegistration result =
          frames.add(scene.see(truth[i], i), reported(truth[i], i), kSigma);
      ASSERT_EQ(result.status, RegistrationStatus::registered) << i << " " << result.reason;
      EXPECT_TRUE(result.reason.empty());
    }
    const std::vector<Pose> poses = poses_of(frames);
    const std::vector<FrameRegistration>& registrations = frames.registrations();
    ASSERT_EQ(poses.size(), truth.size());
    ASSERT_EQ(registrations.size(), truth.size());
    EXPECT_EQ(poses[0], orthonormalized(truth[0]));
    EXPECT_EQ(registrations[0].pose_sigma(), PoseSigma{});
    int cases = 0;
    double squares = 0;  // of errors in units of the covariance
    for (std::size_t i = 1; i < truth.size(); ++i) {
      // Of the surface that is seen: a camera may turn about it as its centre moves.
      const Eigen::Vector3d middle(0, 0, 0.95 * test::RegistrationScene::kDistance - 0.12);
      EXPECT_LT((poses[i] * middle - truth[i] * middle).norm(), 1e-3) << i;
      EXPECT_LT(test::error_of(poses[i], truth[i]).rotation, (noise ? 0.65 : 0.45) * kDegree) << i;
      EXPECT_LT(registrations[i].residual_after, registrations[i].residual_before) << i;
      EXPECT_EQ(registrations[i].T_world_camera, poses[i]);
      EXPECT_GT(registrations[i].overlap, 0.5);
      EXPECT_LT(registrations[i].contradiction, 0.05);
      const PoseSigma sigma = registrations[i].pose_sigma();
      EXPECT_GT(sigma.translation, 0) << i;
      EXPECT_LT(sigma.translation, kShift) << i;
      EXPECT_LT(sigma.rotation, kTurn) << i;
      const auto error = test::difference(poses[i], truth[i]);
      squares += error.dot(test::covariance_of(registrations[i]).inverse() * error) / 6;
      ++cases;
    }
    EXPECT_EQ(cases, 7);
    if (noise) {
      EXPECT_LT(squares / cases, 3);
      EXPECT_GT(squares / cases, 0.1);
    }
  }
}

TEST(AlignFrames, WhatSlidesStaysAsReported) {
  const test::RegistrationScene scene(test::wall(1.2), false, {});
  FrameAlignment frames = scene.alignment();
  const Pose first = test::camera_at(0, 5, test::RegistrationScene::kDistance);
  (void)frames.add(scene.see(first, 0), first, kSigma);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Pose pose = test::disturbed(first, kShift, kTurn, seed);
    const FrameRegistration result = frames.add(scene.see(first, seed), pose, kSigma);
    ASSERT_EQ(result.status, RegistrationStatus::registered) << result.reason;
    EXPECT_EQ(result.free_directions.size(), 3U);  // along the wall, about its normal
    const Eigen::Vector3d way = result.T_world_camera.translation() - pose.translation();
    EXPECT_LT(std::hypot(way.y(), way.z()), 1e-3);
    EXPECT_LT(std::abs(result.T_world_camera.translation().x() - first.translation().x()), 1e-3);
  }
}

// What frames hold says nothing of what they do not: poses that fit exactly are no surer along it.
TEST(AlignFrames, ExactPosesAreNotSureOfWhatSlides) {
  const test::RegistrationScene scene(test::wall(1.2), false, {});
  FrameAlignment frames = scene.alignment();
  const Pose pose = test::camera_at(0, 5, test::RegistrationScene::kDistance);
  for (std::size_t i = 0; i < 4; ++i) (void)frames.add(scene.see(pose, i), pose);
  for (std::size_t i = 1; i < 4; ++i) {
    const FrameRegistration& result = frames.registrations()[i];
    ASSERT_EQ(result.status, RegistrationStatus::registered) << result.reason;
    ASSERT_EQ(result.free_directions.size(), 3U);
    for (const FreeDirection& free : result.free_directions) {
      Eigen::Matrix<double, 6, 1> v;
      v << free.translation / std::pow(kUsualPoseSigma.translation, 2),
          free.rotation / std::pow(kUsualPoseSigma.rotation, 2);
      EXPECT_NEAR(v.dot(test::covariance_of(result) * v), 1, 1e-6);
    }
    EXPECT_LT(test::covariance_of(result)(0, 0), 1e-6);  // to the wall [m²]
  }
}

// Along a wall with bumps, each frame overlaps with the next ones alone. Two that are wrong alike
// hold each other, until the first of them is found out.
TEST(AlignFrames, WhatLosesItsHoldGoesBackToWhereItWasReported) {
  const TriangleMesh wall = test::sheet(400, 120, [](double s, double t) {
    const double y = 1.6 * s - 0.3, z = 0.5 * (t - 0.5);
    const double bumps = std::sin(40 * y) * std::sin(50 * z) + std::sin(65 * y + 1);
    return Eigen::Vector3d(0.008 * bumps, y, z);
  });
  const test::RegistrationScene scene(wall, false, {});
  ScorerConfig map;
  map.voxel_size = scene.kVoxel;
  map.workspace = {{-0.3, -0.4, -0.3}, {0.3, 1.4, 0.3}};
  FrameAlignment frames(scene.sensor, map, {1});
  const auto view = [](double y, double x) { return look_at({x, y, 0}, {0, y, 0}); };
  const auto add = [&](double y, double off) {
    return frames.add(scene.see(view(y, 0.5), 1), view(y, 0.5 + off), kSigma);
  };
  (void)add(0, 0);
  EXPECT_EQ(add(0.45, 0.1).status, RegistrationStatus::too_little_overlap);
  EXPECT_EQ(add(0.68, 0.112).status, RegistrationStatus::registered);
  EXPECT_GT(frames.registrations()[2].translation, 0.003);
  EXPECT_EQ(add(0.26, 0).status, RegistrationStatus::registered);
  EXPECT_EQ(frames.registrations()[1].status, RegistrationStatus::refused);
  const FrameRegistration& lost = frames.registrations()[2];
  EXPECT_EQ(lost.status, RegistrationStatus::too_little_overlap) << lost.reason;
  EXPECT_EQ(lost.T_world_camera, orthonormalized(view(0.68, 0.612)));
  EXPECT_NEAR(lost.pose_sigma().translation, kShift, 1e-12);
}

// What is not in reach of the prior moves nothing and is kept out, unless it lies where it might be
// new surface.
TEST(AlignFrames, FarOffIsRefused) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), true, {});
  FrameAlignment frames = scene.alignment();
  const std::vector<Pose> truth = ring(8);
  for (std::size_t i = 0; i < 4; ++i) {
    (void)frames.add(scene.see(truth[i], i), reported(truth[i], i), kSigma);
  }
  const std::vector<Pose> before = poses_of(frames);
  std::size_t cases = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    for (const Pose& pose : {test::disturbed(truth[1], 0.1, 0, seed),
                             test::disturbed(truth[1], 0, 30 * kDegree, seed)}) {
      const FrameRegistration result = frames.add(scene.see(truth[1], 100 + seed), pose, kSigma);
      EXPECT_NE(result.status, RegistrationStatus::registered) << seed;
      refused += result.status == RegistrationStatus::refused ? 1 : 0;
      EXPECT_FALSE(result.reason.empty());
      EXPECT_EQ(result.T_world_camera, orthonormalized(pose));
      std::vector<Pose> after = poses_of(frames);
      ASSERT_EQ(after.size(), 5 + cases);
      after.resize(4);
      EXPECT_EQ(after, before);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 8U);
  EXPECT_GE(refused, 7U);
}

// Frames that come before those that tell that they are wrong are found out when these come.
TEST(AlignFrames, WhoIsWrongIsToldByThoseThatAgree) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), true, {});
  const std::vector<Pose> truth = ring(8);
  for (const Pose& wrong :
       {test::disturbed(truth[4], 0.1, 0, 5), test::disturbed(truth[4], 0, 30 * kDegree, 6)}) {
    FrameAlignment frames = scene.alignment();
    // Far from the first, so that the first says nothing of it.
    (void)frames.add(scene.see(truth[0], 0), truth[0], kSigma);
    (void)frames.add(scene.see(truth[4], 4), wrong, kSigma);
    for (const std::size_t i : {1U, 2U, 3U, 5U, 6U, 7U}) {
      (void)frames.add(scene.see(truth[i], i), reported(truth[i], i), kSigma);
    }
    EXPECT_EQ(frames.registrations()[1].status, RegistrationStatus::refused);
    EXPECT_EQ(frames.registrations()[1].T_world_camera, orthonormalized(wrong));
    for (std::size_t i = 2; i < 8; ++i) {
      EXPECT_EQ(frames.registrations()[i].status, RegistrationStatus::registered)
          << i << " " << frames.registrations()[i].reason;
    }
  }
}

TEST(AlignFrames, WithoutOverlapAPoseWaitsForWhatShowsMore) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), false, {});
  FrameAlignment frames = scene.alignment();
  const std::vector<Pose> truth = ring(8);
  (void)frames.add(scene.see(truth[0], 0), truth[0], kSigma);
  const Pose pose = reported(truth[4], 4);  // behind the object
  const FrameRegistration alone = frames.add(scene.see(truth[4], 4), pose, kSigma);
  EXPECT_EQ(alone.status, RegistrationStatus::too_little_overlap);
  EXPECT_NE(alone.reason.find("another frame"), std::string::npos) << alone.reason;
  EXPECT_EQ(alone.T_world_camera, orthonormalized(pose));
  for (const std::size_t i : {1U, 2U, 3U}) {
    (void)frames.add(scene.see(truth[i], i), reported(truth[i], i), kSigma);
  }
  const FrameRegistration later = frames.registrations()[1];
  EXPECT_EQ(later.status, RegistrationStatus::registered) << later.reason;
  const double before = test::error_of(pose, truth[4]).translation;
  EXPECT_LT(test::error_of(later.T_world_camera, truth[4]).translation, 0.7 * before);

  DepthFrame nothing = scene.see(truth[0]);
  nothing.depth.assign(nothing.depth.size(), DepthFrame::kInvalid);
  EXPECT_EQ(frames.add(nothing, truth[0], kSigma).status, RegistrationStatus::too_little_overlap);
}

// Its two sides lie in one place and are two surfaces.
TEST(AlignFrames, TheBackOfASheetIsNoPairOfItsFront) {
  const test::RegistrationScene scene(test::wall(1.2), false, {});
  const Pose front = test::camera_at(0, 5, test::RegistrationScene::kDistance);
  const Pose back = test::camera_at(180, 5, test::RegistrationScene::kDistance);
  FrameAlignment frames = scene.alignment();
  (void)frames.add(scene.see(front), front, kSigma);
  const FrameRegistration again = frames.add(scene.see(front), front, kSigma);
  EXPECT_EQ(again.status, RegistrationStatus::registered) << again.reason;
  EXPECT_GT(again.pairs, 1000U);
  const FrameRegistration behind = frames.add(scene.see(back), back, kSigma);
  EXPECT_EQ(behind.status, RegistrationStatus::too_little_overlap) << behind.reason;
  EXPECT_GT(behind.readings, 1000U);
  EXPECT_EQ(behind.pairs, 0U);
}

TEST(AlignFrames, TheSameBitsForAnyNumberOfThreads) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), true, {});
  FrameAlignment one = scene.alignment(1), three = scene.alignment(3);
  const std::vector<Pose> truth = ring(8);
  for (std::size_t i = 0; i < 4; ++i) {
    (void)one.add(scene.see(truth[i], i), reported(truth[i], i), kSigma);
    (void)three.add(scene.see(truth[i], i), reported(truth[i], i), kSigma);
    EXPECT_EQ(poses_of(one), poses_of(three)) << i;
  }
  EXPECT_EQ(one.registrations().size(), 4U);
}

TEST(AlignFrames, BadInputIsRefusedByNameAndChangesNothing) {
  const test::RegistrationScene scene(test::wall(1.2), false, {});
  FrameAlignment frames = scene.alignment();
  const Pose pose = test::camera_at(0, 5, test::RegistrationScene::kDistance);
  const DepthFrame frame = scene.see(pose);
  const ErrorCode code = ErrorCode::invalid_argument;
  test::expect_error(code, "sigma_translation", [&] { (void)frames.add(frame, pose, {0, kTurn}); });
  test::expect_error(code, "sigma_rotation", [&] {
    (void)frames.add(frame, pose, {kShift, std::numeric_limits<double>::infinity()});
  });
  Pose squeezed = pose;
  squeezed.m[0] += 0.1;
  test::expect_error(code, "rigid", [&] { (void)frames.add(frame, squeezed, kSigma); });
  DepthFrame small = frame;
  small.width -= 1;
  test::expect_error(code, "", [&] { (void)frames.add(small, pose, kSigma); });
  EXPECT_TRUE(frames.registrations().empty());
}

}  // namespace
}  // namespace viewgain
