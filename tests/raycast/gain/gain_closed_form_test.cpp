// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains that can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/gain.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using test::axis_pose;
using test::lattice_sensor;
using test::sparse_map;

constexpr double kAxial = 0.02;     ///< [m]
constexpr double kLateral = 0.005;  ///< [m]
constexpr double kPrior = 0.1;      ///< [m]

double squared(double x) { return x * x; }

/// 1 / (1/prior² + n/sigma²): variance after n readings of one sigma.
double fused(double sigma, double readings = 1) {
  return 1 / (1 / squared(kPrior) + readings / squared(sigma));
}

Sensor anisotropic(int width = 1, int height = 1) {
  Sensor sensor = lattice_sensor(width, height);
  sensor.noise = ConstantNoise{.sigma_axial = kAxial, .sigma_lateral = kLateral};
  return sensor;
}

ViewGain score(const BeliefGrid& grid, const Sensor& sensor, const Pose& pose,
               Criterion criterion) {
  GainConfig config = test::by_paper(criterion);
  config.prior_sigma = kPrior;
  config.posterior_entropy = true;
  return GainEvaluator(VoxelScene::build(grid), sensor, config, {.num_threads = 1}).evaluate(pose);
}

TEST(GainClosedForm, OneVoxelOneRay) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{6, 6, 6}}, VoxelState::unknown);
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    Eigen::Vector3d eye = Eigen::Vector3d::Constant(6.5);
    eye[axis] = -2;
    const Pose pose = axis_pose(eye, axis, true);
    const double logs = std::log(squared(kPrior) / fused(kLateral)) +
                        0.5 * std::log(squared(kPrior) / fused(kAxial));
    const ViewGain diagonal = score(grid, anisotropic(), pose, Criterion::log_diagonal);
    EXPECT_NEAR(diagonal.gain, logs, 1e-9 * logs);
    EXPECT_EQ(diagonal.gain, diagonal.exploration);
    EXPECT_EQ(diagonal.refinement, 0.0);
    EXPECT_NEAR(diagonal.posterior_entropy, 4 * std::log(kLateral) + 2 * std::log(kAxial), 1e-9);
    EXPECT_EQ(diagonal.hits, 1U);
    EXPECT_EQ(diagonal.unknown_voxels, 1U);
    EXPECT_EQ(diagonal.occupied_voxels, 0U);
    const ViewGain determinant = score(grid, anisotropic(), pose, Criterion::log_determinant);
    EXPECT_NEAR(determinant.gain, logs, 1e-9 * logs);
    const ViewGain trace = score(grid, anisotropic(), pose, Criterion::trace);
    const double variances = 3 * squared(kPrior) - 2 * fused(kLateral) - fused(kAxial);
    EXPECT_NEAR(trace.gain, variances, 1e-9 * variances);
  }
}

// The ray ends 8 voxels away, where the turn moves it by 8 mm.
TEST(GainClosedForm, PosesThatAreNotSureMakeReadingsLessSure) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{6, 6, 6}}, VoxelState::unknown);
  Sensor sensor = anisotropic();
  sensor.max_range = 100;  // m, beyond which turns would make all readings flat
  sensor.pose_sigma = {0.01, 0.008 / (8 * test::kExactVoxel)};
  const double axial = std::hypot(kAxial, 0.01), lateral = std::hypot(kLateral, 0.01, 0.008);
  const double expected =
      std::log(squared(kPrior) / fused(lateral)) + 0.5 * std::log(squared(kPrior) / fused(axial));
  const Pose pose = axis_pose({-2, 6.5, 6.5}, 0, true);
  const double gain = score(grid, sensor, pose, Criterion::log_diagonal).gain;
  EXPECT_NEAR(gain, expected, 1e-6 * expected);
  EXPECT_LT(gain, score(grid, anisotropic(), pose, Criterion::log_diagonal).gain);
}

TEST(GainClosedForm, TwoPerpendicularReadingsInOneVoxel) {
  // The paper's Fig. 3: a voxel seen along x, then along z. Each view is sharp where the other is
  // not.
  BeliefGrid grid = sparse_map({16, 16, 16}, {{6, 6, 6}});
  Belief belief;
  const auto a = static_cast<float>(1 / squared(kLateral));
  const auto b = static_cast<float>(1 / squared(kAxial));
  belief.information = {b, a, a, 0, 0, 0};
  belief.hits = 1;
  grid.set({6, 6, 6}, 0.85F, belief);
  const Pose pose = axis_pose({6.5, 6.5, -2}, 2, true);

  const double both = 1 / (1 / squared(kPrior) + 1 / squared(kLateral) + 1 / squared(kAxial));
  const double twice = fused(kLateral, 2);
  // Before: x axial, y and z lateral. After: x both, y lateral twice, z both.
  const double logs = 0.5 * (std::log(fused(kAxial) / both) + std::log(fused(kLateral) / twice) +
                             std::log(fused(kLateral) / both));
  const double variances = fused(kAxial) + 2 * fused(kLateral) - 2 * both - twice;
  const ViewGain diagonal = score(grid, anisotropic(), pose, Criterion::log_diagonal);
  EXPECT_NEAR(diagonal.gain, logs, 1e-6 * logs);
  EXPECT_EQ(diagonal.gain, diagonal.refinement);
  EXPECT_EQ(diagonal.occupied_voxels, 1U);
  EXPECT_NEAR(score(grid, anisotropic(), pose, Criterion::log_determinant).gain, logs, 1e-6 * logs);
  EXPECT_NEAR(score(grid, anisotropic(), pose, Criterion::trace).gain, variances, 1e-6 * variances);

  // A second look along x says less than the perpendicular one.
  const Pose again = axis_pose({-2, 6.5, 6.5}, 0, true);
  EXPECT_LT(score(grid, anisotropic(), again, Criterion::log_diagonal).gain, diagonal.gain);
}

TEST(GainClosedForm, TwoPerpendicularRaysOfOneView) {
  // A camera inside an unknown voxel: its outer rays, (-1,0,1) and (1,0,1), end in that voxel.
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{6, 6, 6}}, VoxelState::unknown);
  Sensor sensor = anisotropic(2, 1);
  sensor.camera.fx = 0.5;  // the two pixels look 45° to the left and to the right
  const Pose pose = axis_pose({6.5, 6.5, 6.5}, 2, true);
  const double p = 1 / squared(kPrior);
  const double both = p + 1 / squared(kLateral) + 1 / squared(kAxial);
  const double across = p + 2 / squared(kLateral);
  const double logs = 0.5 * (2 * std::log(both / p) + std::log(across / p));
  EXPECT_NEAR(score(grid, sensor, pose, Criterion::log_diagonal).gain, logs, 1e-6 * logs);
  EXPECT_NEAR(score(grid, sensor, pose, Criterion::log_determinant).gain, logs, 1e-6 * logs);
  const double variances = 3 / p - 2 / both - 1 / across;
  EXPECT_NEAR(score(grid, sensor, pose, Criterion::trace).gain, variances, 1e-6 * variances);
}

}  // namespace
}  // namespace viewgain
