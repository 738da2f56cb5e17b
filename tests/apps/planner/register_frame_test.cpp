// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Frames of known shapes from known poses, reported a little off.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "apps/planner/planner_set_up.hpp"
#include "apps/planner/registration_scene.hpp"
#include "core/expect_error.hpp"
#include "viewgain/planner/align_frames.hpp"

namespace viewgain {
namespace {

using test::kDegree;

constexpr double kShift = 0.01, kTurn = kDegree;
constexpr double kDistance = test::RegistrationScene::kDistance;

Pose true_pose() { return test::camera_at(0, 5, kDistance); }
constexpr PoseSigma kSigma{kShift, kTurn};

FrameRegistration registered(const test::RegistrationScene& scene, const DepthFrame& frame,
                             const Pose& reported, int threads = 1) {
  return scene.alignment(threads).register_frame(scene.grid, frame, reported, kSigma);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(RegisterFrame, WithoutNoiseThePoseIsRecovered) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), false, test::views_round());
  const DepthFrame frame = scene.see(true_pose());
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Pose reported = test::disturbed(true_pose(), kShift, kTurn, seed);
    const FrameRegistration result = registered(scene, frame, reported);
    ASSERT_EQ(result.status, RegistrationStatus::registered) << result.reason;
    const test::PoseError error = test::error_of(result.T_world_camera, true_pose());
    EXPECT_LT(error.translation, 1e-3) << seed;
    EXPECT_LT(error.rotation, 0.2 * kDegree) << seed;
    EXPECT_LT(result.residual_after, 0.5 * result.residual_before) << seed;
    EXPECT_GT(result.overlap, 0.9);
    EXPECT_TRUE(result.free_directions.empty());
    EXPECT_TRUE(result.reason.empty());
    const Pose& corrected = result.T_world_camera;
    EXPECT_NEAR(result.translation, (corrected.translation() - reported.translation()).norm(),
                1e-12);
    EXPECT_NEAR(result.rotation, test::error_of(corrected, reported).rotation, 1e-9);
  }
}

TEST(RegisterFrame, APlannerSaysWhatItsPartsSayAndStaysAsItWas) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), true, {});
  test::PlannerSetUp config;
  config.map.voxel_size = test::RegistrationScene::kVoxel;
  config.map.workspace = scene.grid.workspace();
  ViewPlanner planner = config.make(scene.sensor, {1});
  const DepthFrame frame = scene.see(true_pose());
  const Pose reported = test::disturbed(true_pose(), kShift, kTurn, 1);
  EXPECT_EQ(planner.register_frame(frame, reported, kSigma).status,
            RegistrationStatus::too_little_overlap);
  for (const Pose& view : test::views_round()) planner.add(scene.see(view), view);
  const std::string before = planner.scorer().grid().content_hash();
  const FrameRegistration found = planner.register_frame(frame, reported, kSigma);
  ASSERT_EQ(found.status, RegistrationStatus::registered) << found.reason;
  EXPECT_LT(test::error_of(found.T_world_camera, true_pose()).translation, 0.6 * kShift);
  EXPECT_EQ(planner.scorer().grid().content_hash(), before);
  ScorerConfig map;
  map.jump_edges = config.map.jump_edges;
  const FrameAlignment part(scene.sensor, map, {2});
  EXPECT_EQ(part.register_frame(planner.scorer().grid(), frame, reported, kSigma).T_world_camera,
            found.T_world_camera);
}

TEST(RegisterFrame, WithNoiseItIsRecoveredToMillimetresAndKnowsHowWell) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), true, test::views_round());
  std::vector<double> translations, rotations;
  double squares = 0;  // of errors in units of the covariance
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const FrameRegistration result = registered(scene, scene.see(true_pose(), 1000 + seed),
                                                test::disturbed(true_pose(), kShift, kTurn, seed));
    ASSERT_EQ(result.status, RegistrationStatus::registered) << result.reason;
    const test::PoseError error = test::error_of(result.T_world_camera, true_pose());
    translations.push_back(error.translation);
    rotations.push_back(error.rotation);
    const auto d = test::difference(result.T_world_camera, true_pose());
    squares += d.dot(test::covariance_of(result).inverse() * d) / 6;
  }
  ASSERT_EQ(translations.size(), 10U);
  EXPECT_LT(median(translations), 4e-3);
  EXPECT_LT(median(rotations), 0.4 * kDegree);
  EXPECT_GT(squares / 10, 0.2);
  EXPECT_LT(squares / 10, 3.0);
}

// A shape on which the camera can move without a change, and how many such motions there are.
struct Slide {
  std::string name;
  TriangleMesh mesh;
  std::size_t free;
  /// Speed of the camera's centre and rotation of the motions, world axes, about the origin.
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> motions;
};

std::vector<Slide> slides() {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ(), none = Eigen::Vector3d::Zero();
  return {{"sphere", test::bumpy_sphere(0.12, 0), 3, {{none, x}, {none, y}, {none, z}}},
          {"cylinder", test::cylinder(0.1, 0.8), 2, {{z, none}, {none, z}}},
          {"wall", test::wall(1.2), 3, {{y, none}, {z, none}, {none, x}}}};
}

TEST(RegisterFrame, WhatSlidesStaysWithThePrior) {
  int cases = 0;
  for (const Slide& shape : slides()) {
    for (const bool noise : {false, true}) {
      const test::RegistrationScene scene(shape.mesh, noise, test::views_round());
      const DepthFrame frame = scene.see(true_pose());
      Eigen::Matrix<double, 6, 1> sigmas;
      sigmas << Eigen::Vector3d::Constant(kShift), Eigen::Vector3d::Constant(kTurn);
      for (std::uint64_t seed = 0; seed < 3; ++seed) {
        SCOPED_TRACE(shape.name + (noise ? " noise " : " exact ") + std::to_string(seed));
        const Pose reported = test::disturbed(true_pose(), kShift, kTurn, seed);
        const FrameRegistration result = registered(scene, frame, reported);
        ASSERT_EQ(result.status, RegistrationStatus::registered) << result.reason;
        ASSERT_EQ(result.free_directions.size(), shape.free);
        EXPECT_LT(result.smallest_information, 1);
        // In units of the prior's sigmas: the motions of the shape lie in the span of those found.
        Eigen::Matrix<double, 6, Eigen::Dynamic> found(6, result.free_directions.size());
        for (std::size_t k = 0; k < result.free_directions.size(); ++k) {
          const FreeDirection& free = result.free_directions[k];
          Eigen::Matrix<double, 6, 1> motion;
          motion << free.translation, free.rotation;
          found.col(static_cast<Eigen::Index>(k)) = motion.cwiseQuotient(sigmas);
          EXPECT_NEAR(found.col(static_cast<Eigen::Index>(k)).norm(), 1, 1e-6);
        }
        const Eigen::Matrix<double, 6, 1> correction =
            test::difference(result.T_world_camera, reported).cwiseQuotient(sigmas);
        for (const auto& [along, about] : shape.motions) {
          Eigen::Matrix<double, 6, 1> motion;
          motion << along + about.cross(true_pose().translation()), about;
          motion = motion.cwiseQuotient(sigmas).normalized().eval();
          EXPECT_GT((found.transpose() * motion).norm(), 0.98);
          EXPECT_LT(std::abs(correction.dot(motion)), noise ? 0.12 : 0.06);
          ++cases;
        }
        // The prior's covariance stays along them.
        for (Eigen::Index k = 0; k < found.cols(); ++k) {
          const Eigen::Matrix<double, 6, 1> v = found.col(k).cwiseQuotient(sigmas);
          EXPECT_NEAR(v.dot(test::covariance_of(result) * v), 1, 1e-6);
        }
        EXPECT_LT(result.residual_after, (noise ? 6e-3 : 0.5e-3));
      }
    }
  }
  EXPECT_EQ(cases, 2 * 3 * (3 + 2 + 3));
}

TEST(RegisterFrame, TooLittleOverlapLeavesThePose) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), false, test::views_round());
  const FrameAlignment alignment = scene.alignment();
  const Pose reported = test::disturbed(true_pose(), kShift, kTurn, 1);
  const auto expect_as_reported = [&](const FrameRegistration& result, const std::string& part) {
    EXPECT_EQ(result.status, RegistrationStatus::too_little_overlap);
    EXPECT_NE(result.reason.find(part), std::string::npos) << result.reason;
    EXPECT_EQ(result.covariance[1], 0);
  };
  const auto expect_the_prior = [&](const FrameRegistration& result) {
    EXPECT_EQ(result.covariance[0], kShift * kShift);
    EXPECT_EQ(result.covariance[35], kTurn * kTurn);
    EXPECT_NEAR(result.pose_sigma().translation, kShift, 1e-12);
    EXPECT_NEAR(result.pose_sigma().rotation, kTurn, 1e-12);
  };
  const FrameRegistration in_empty = alignment.register_frame(
      BeliefGrid(scene.layout()), scene.see(true_pose()), reported, kSigma);
  expect_as_reported(in_empty, "no surface yet");
  EXPECT_EQ(in_empty.pose_sigma(), PoseSigma{});  // the frame says where the map is
  EXPECT_EQ(in_empty.T_world_camera, orthonormalized(reported));

  DepthFrame nothing = scene.see(true_pose());
  std::fill(nothing.depth.begin(), nothing.depth.end(), DepthFrame::kInvalid);
  expect_as_reported(alignment.register_frame(scene.grid, nothing, reported, kSigma),
                     "no surface in the workspace");
  std::fill(nothing.depth.begin(), nothing.depth.end(), DepthFrame::kOutOfRange);
  expect_as_reported(alignment.register_frame(scene.grid, nothing, reported, kSigma),
                     "no surface in the workspace");

  // From behind the map shows nothing.
  const Pose behind = test::camera_at(180, 0, kDistance);
  const FrameRegistration from_behind =
      alignment.register_frame(scene.grid, scene.see(behind), behind, kSigma);
  expect_as_reported(from_behind, "points lie on surface that is also in the map");
  expect_the_prior(from_behind);
  EXPECT_EQ(from_behind.T_world_camera, behind);
  EXPECT_GT(from_behind.readings, 1000U);
}

TEST(RegisterFrame, ReadingsOfTheTableAndOfWhatIsKnownAreLeftOut) {
  const test::RegistrationScene scene(test::bumpy_sphere(0.12, 0.015), false, test::views_round());
  const DepthFrame frame = scene.see(true_pose());
  const std::size_t all = registered(scene, frame, true_pose()).readings;
  ScorerConfig map;
  map.support_plane = 0.0;
  const FrameRegistration above =
      FrameAlignment(scene.sensor, map, {1}).register_frame(scene.grid, frame, true_pose(), kSigma);
  EXPECT_LT(above.readings, 0.7 * static_cast<double>(all));
  EXPECT_GT(above.readings, 0.3 * static_cast<double>(all));
  map.obstacles.boxes.push_back({{-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}});
  EXPECT_EQ(FrameAlignment(scene.sensor, map, {1})
                .register_frame(scene.grid, frame, true_pose(), kSigma)
                .readings,
            0U);
}

TEST(RegisterFrame, BadInputIsRefusedByName) {
  const test::RegistrationScene scene(test::wall(1.2), false, {true_pose()});
  const DepthFrame frame = scene.see(true_pose());
  const FrameAlignment alignment = scene.alignment();
  const auto call = [&](const DepthFrame& f, const Pose& pose, const PoseSigma& sigma) {
    return [&alignment, &scene, &f, pose, sigma] {
      (void)alignment.register_frame(scene.grid, f, pose, sigma);
    };
  };
  const ErrorCode code = ErrorCode::invalid_argument;
  test::expect_error(code, "sigma_translation", call(frame, true_pose(), {0, kTurn}));
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    test::expect_error(code, "sigma_rotation", call(frame, true_pose(), {kShift, bad}));
  }
  Pose squeezed = true_pose();
  squeezed.m[0] += 0.1;
  test::expect_error(code, "rigid", call(frame, squeezed, kSigma));
  DepthFrame small = frame;
  small.width -= 1;
  test::expect_error(code, "", call(small, true_pose(), kSigma));
}

}  // namespace
}  // namespace viewgain
