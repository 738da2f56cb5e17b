// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Numbers at their limits: right, or refused with the limit named.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/covariance.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

constexpr int kFusedFrames = kSlowBuild ? 10 : 100;

/// A million readings of one point, 10,000 a frame, from a cone round +z or a side that is `tilt`
/// off it [rad]; their sum is known in double precision, too.
struct Fusions {
  Fusions(const ConstantNoise& noise, double cone, double tilt = 0)
      : grid({1, {{-8, -8, -8}, {8, 8, 8}}, {}, 0.5}), sensor(small_sensor(100, 100)) {
    sensor.camera = {100, 100, 1e6, 1e6, 49.5, 49.5, {}};
    sensor.noise = noise;
    FrameIntegrator integrator(sensor);
    const Eigen::Vector3d point(0.5, 0.5, 0.5);
    for (int i = 0; i < kFusedFrames; ++i) {
      const Eigen::AngleAxisd turn(tilt > 0 ? 0.7 : 2.4 * i, Eigen::Vector3d::UnitZ());
      const Eigen::AngleAxisd away(cone * i / kFusedFrames + tilt, Eigen::Vector3d::UnitX());
      pose = look_at(point + turn * away * Eigen::Vector3d(0, 0, 2), point);
      integrator.integrate(grid, {100, 100, std::vector<float>(10'000, 2.0F)}, pose);
      for (const Eigen::Vector3d& ray : sensor.camera.ray_table()) {
        const Eigen::Vector3d d = pose.rotation() * ray.normalized();
        expected += measurement_information(d, {noise.sigma_axial, noise.sigma_lateral}).matrix();
      }
    }
    information = grid.belief({0, 0, 0}).value_or(Belief{}).information_matrix();
  }

  /// What is off, against sqrt(Λ_ii Λ_jj).
  [[nodiscard]] double off() const {
    const Eigen::Vector3d scale = expected.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::Matrix3d off =
        scale.asDiagonal() * (information.matrix() - expected) * scale.asDiagonal();
    return off.cwiseAbs().maxCoeff();
  }

  BeliefGrid grid;
  Sensor sensor;
  Pose pose;  // of the last frame
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  SymmetricMatrix3 information;
};

// Single precision rounds each of the 100 sums by at most 2^-23 of itself.
TEST(Limits, AMillionFusionsStayPositiveDefinite) {
  for (const double axial : {0.004, 0.1}) {
    SCOPED_TRACE(axial);
    const Fusions fusions({axial, 0.002}, 1.0);
    EXPECT_EQ(fusions.grid.belief({0, 0, 0})->hits, 10'000U * kFusedFrames);
    EXPECT_LT(fusions.off(), kFusedFrames * 0x1p-23);
    EXPECT_GT(fusions.information.inverse().inverse().xx, 0);
    const std::vector<FusedPoint> points = fused_points(fusions.grid);
    ASSERT_EQ(points.size(), 1U);
    EXPECT_GT(points[0].covariance.inverse().xx, 0);
  }
}

// All from one side at a slant, so that no axis of the grid is the weak one, with sigmas up to a
// factor of 1,000 apart. A frame's sum is rounded once, up or down by chance: after n frames the
// weak axis is off by some √n 2^-24 of the strong one.
TEST(Limits, AMillionReadingsOfOneSideKeepTheirWeakAxis) {
  int cases = 0;
  for (const double ratio : {10.0, 100.0, 1000.0}) {
    for (const double tilt : {0.5, 0.9}) {
      for (const bool along : {true, false}) {  // the weak axis: the ray, or all across it
        SCOPED_TRACE(testing::Message() << ratio << ", " << tilt << ", " << along);
        const ConstantNoise noise{along ? 1e-3 * ratio : 1e-3, along ? 1e-3 : 1e-3 * ratio};
        const Fusions fusions(noise, 0, tilt);
        EXPECT_LT(fusions.off(), kFusedFrames * 0x1p-23);
        const auto weakest = [](const Eigen::Matrix3d& information) {
          return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues()[0];
        };
        const double expected = weakest(fusions.expected);
        EXPECT_NEAR(
            weakest(fusions.information.matrix()), expected,
            std::min(4 * std::sqrt(kFusedFrames) * 0x1p-24 * ratio * ratio, 0.4) * expected);
        EXPECT_EQ(fused_points(fusions.grid).size(), 1U);
        const auto scene = VoxelScene::build(fusions.grid);
        for (const GainModel model : {GainModel::paper, GainModel::combined}) {
          const GainEvaluator evaluator(scene, fusions.sensor, {.model = model});
          for (const Pose& pose : {fusions.pose, look_at({2.5, 0.5, 0.5}, {0.5, 0.5, 0.5})}) {
            EXPECT_GE(evaluator.evaluate(pose).gain, 0);
          }
        }
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 12);
}

// One reading a frame, so that each is rounded.
TEST(Limits, AMillionFramesOfOneReadingKeepTheirWeakAxis) {
  BeliefGrid grid({1, {{-8, -8, -8}, {8, 8, 8}}, {}, 0.5});
  Sensor sensor = small_sensor(8, 8);
  sensor.noise = ConstantNoise{0.03, 0.001};
  CloudIntegrator integrator(sensor);
  const Eigen::Vector3d point(0.5, 0.5, 0.5), side(0.6, 0.48, 0.64);
  const std::vector<std::array<double, 3>> points{{0.5, 0.5, 0.5}};
  constexpr int kFrames = kSlowBuild ? 100'000 : 1'000'000;
  for (int i = 0; i < kFrames; ++i)
    integrator.integrate(grid, points, look_at(point + side, point));
  const Belief belief = grid.belief({0, 0, 0}).value();
  EXPECT_EQ(belief.hits, kFrames);
  const double weak = side.dot(belief.information_matrix() * side) / kFrames;
  EXPECT_NEAR(weak, 1 / (0.03 * 0.03), 4 * std::sqrt(kFrames) * 0x1p-24 * 1e6);
}

// Each a part of a step of single precision: chance adds a whole step to as many of the sums.
TEST(Limits, ReadingsBelowAStepCountAsOften) {
  const double step = 0x1p33 * 0x1p-23;  // of a sum in 2^32 .. 2^33, twice that of one below [m⁻²]
  for (const double share : {0.02, 0.2}) {
    BeliefGrid grid({1, {{-8, -8, -8}, {8, 8, 8}}, {}, 0.5});
    Sensor sensor = small_sensor(8, 8);
    const std::vector<std::array<double, 3>> points{{0.5, 0.5, 0.5}};
    const Pose pose = look_at({1.1, 0.98, 1.14}, {0.5, 0.5, 0.5});
    sensor.noise = ConstantNoise{1e-4, 1e-4};
    CloudIntegrator sharp(sensor);
    for (int i = 0; i < 50; ++i) sharp.integrate(grid, points, pose);
    const double before = grid.belief({0, 0, 0}).value().information_matrix().trace();
    EXPECT_NEAR(before, 3 * 50 * 1e8, 1e4);
    const double sigma = 1 / std::sqrt(share * step);
    sensor.noise = ConstantNoise{sigma, sigma};
    CloudIntegrator blunt(sensor);
    constexpr int kReadings = 20'000;
    for (int i = 0; i < kReadings; ++i) blunt.integrate(grid, points, pose);
    const double grown = grid.belief({0, 0, 0}).value().information_matrix().trace() - before;
    const double expected = 3 * kReadings * share * step;
    EXPECT_NEAR(grown, expected, 0.15 * expected) << share;
  }
}

// Beyond a factor of 1,000 maps are made, and stay positive definite; views are not scored.
TEST(Limits, SigmasThatDifferByMoreAreRefused) {
  const Fusions fusions({10.0, 1e-3}, 0, 0.5);
  EXPECT_GT(fusions.information.inverse().xx, 0);
  expect_error(ErrorCode::invalid_argument, "differ by at most a factor of 1000", [&] {
    (void)GainEvaluator(VoxelScene::build(fusions.grid), fusions.sensor, kPaper);
  });
}

struct Counts {
  double unknown, occupied, gain;
  ViewSet set;
};

/// What four frames of an object of 48 voxels leave, all lengths as the voxel is, the gain of a
/// view, and three views chosen together.
Counts counts_of(double voxel, const Eigen::Vector3d& shift) {
  const double scale = voxel / (0.4 / 48);
  Sensor sensor = small_sensor(96, 72);
  sensor.camera.distortion = {};
  sensor.min_range = 0.1 * scale, sensor.max_range = 5 * scale, sensor.working_distance = scale;
  sensor.noise = ConstantNoise{0.002 * scale, 0.001 * scale};
  std::vector<Sphere> spheres = three_spheres_in_a_room();
  for (auto& [center, radius] : spheres) center = scale * center + shift, radius *= scale;
  const double half = 24 * voxel;
  const Pose T_world_grid(Eigen::Matrix3d::Identity(), shift);
  BeliefGrid grid({voxel, {{-half, -half, -half}, {half, half, half}}, T_world_grid, voxel});
  FrameIntegrator integrator(sensor);
  std::vector<Pose> poses;
  for (int i = 0; i < 10; ++i) {
    const Pose pose(ring_view(i).rotation(), scale * ring_view(i).translation() + shift);
    poses.push_back(pose);
    if (i < 4) integrator.integrate(grid, see_spheres(sensor, pose, spheres), pose);
  }
  const BeliefGrid::Statistics statistics = grid.statistics();
  const auto scene = VoxelScene::build(grid);
  return {static_cast<double>(statistics.unknown), static_cast<double>(statistics.occupied),
          GainEvaluator(scene, sensor, kPaper).evaluate(poses[4]).gain,
          GainEvaluator(scene, sensor, {.model = GainModel::combined}).best_set(poses, 3)};
}

TEST(Limits, MapsOfAnyScaleAndPlaceAreAlike) {
  const Eigen::Vector3d far(1e6, -1e6, 1e6);
  const Counts expected = counts_of(1, Eigen::Vector3d::Zero());
  EXPECT_GT(expected.occupied, 1000);
  ASSERT_EQ(expected.set.indices.size(), 3U);
  for (const auto& [voxel, shift] : {std::pair<double, Eigen::Vector3d>{1e-4, {0, 0, 0}},
                                     {10, {0, 0, 0}},
                                     {1e-4, far},
                                     {0.01, far},
                                     {10, far}}) {
    SCOPED_TRACE(testing::Message() << voxel << " m, " << shift.transpose());
    const Counts counts = counts_of(voxel, shift);
    EXPECT_NEAR(counts.unknown, expected.unknown, 0.001 * expected.unknown);
    EXPECT_NEAR(counts.occupied, expected.occupied, 0.005 * expected.occupied);
    EXPECT_NEAR(counts.gain, expected.gain, 0.005 * expected.gain);
    EXPECT_EQ(counts.set.indices, expected.set.indices);
    EXPECT_NEAR(counts.set.gain, expected.set.gain, 0.005 * expected.set.gain);
  }
}

TEST(Limits, LatticesBeyondTheirIntegersAreRefused) {
  const auto at = [](double voxel) {
    return [voxel] { (void)BeliefGrid({voxel, {{1e6, 0, 0}, {1e6 + 1, 1, 1}}, {}, 0.01}); };
  };
  EXPECT_NO_THROW(at(0.01)());
  expect_error(ErrorCode::capacity, "from the origin along x; the maximum is 1073741824", at(1e-4));
}

TEST(Limits, ImagesOfTwelveMillionPixels) {
  const auto scene = VoxelScene::build(sparse_map({16, 16, 16}, {{6, 6, 6}}, VoxelState::unknown));
  Sensor sensor = lattice_sensor(1, 1), small = sensor;
  sensor.camera = {4096, 3072, 4096, 4096, 2047.5, 1535.5, {}};
  small.camera = {512, 384, 512, 512, 2047.5 / 8, 1535.5 / 8, {}};
  GainConfig config = kPaper;
  const Pose pose = axis_pose({6.5, 6.5, -2}, 2, true);
  const ViewGain expected = GainEvaluator(scene, small, config).evaluate(pose);
  config.pixel_stride = 8;
  const ViewGain gain = GainEvaluator(scene, sensor, config).evaluate(pose);
  EXPECT_GT(gain.hits, 1000U);
  EXPECT_EQ(gain.hits, expected.hits);
  EXPECT_NEAR(gain.gain, expected.gain, 1e-9 * expected.gain);
  sensor.camera.height = 4097;
  expect_error(ErrorCode::invalid_argument, "the maximum is 2^24 pixels",
               [&] { (void)GainEvaluator(scene, sensor, config); });
}

}  // namespace
}  // namespace viewgain
