// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What readings do to the belief of the voxel that encloses them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

/// One pixel that looks along the z axis of its pose.
Sensor one_pixel(const NoiseModel& noise) {
  Sensor sensor = small_sensor(1, 1);
  sensor.camera.fx = sensor.camera.fy = 220.0;
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.noise = noise;
  return sensor;
}

DepthFrame one_reading(double depth) { return {1, 1, {static_cast<float>(depth)}}; }

const GridConfig kCube{0.01, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.01};

TEST(Beliefs, TwoPerpendicularReadings) {
  // The paper's figure 3: each reading is sure across its ray, together they are sure everywhere.
  const ConstantNoise noise{0.004, 0.001};
  BeliefGrid grid(kCube);
  FrameIntegrator integrator(one_pixel(noise));
  const Eigen::Vector3d target(0.005, 0.005, 0.005);
  integrator.integrate(grid, one_reading(0.5),
                       look_at(target - Eigen::Vector3d(0.5, 0, 0), target));
  integrator.integrate(grid, one_reading(0.5),
                       look_at(target - Eigen::Vector3d(0, 0.5, 0), target));
  const auto belief = grid.belief({0, 0, 0});
  ASSERT_TRUE(belief.has_value());
  EXPECT_EQ(belief->hits, 2U);
  const double axial = 1.0 / (0.004 * 0.004), lateral = 1.0 / (0.001 * 0.001);
  const auto& L = belief->information;
  EXPECT_NEAR(L[0], axial + lateral, 1e-6 * lateral);
  EXPECT_NEAR(L[1], axial + lateral, 1e-6 * lateral);
  EXPECT_NEAR(L[2], 2 * lateral, 1e-6 * lateral);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(L[i], 0.0, 1e-6 * lateral);
}

// What the pose adds is the same along the ray as a noisier camera; across it grows with the range.
TEST(Beliefs, ReadingsAreNoSurerThanThePose) {
  Sensor sensor = one_pixel(ConstantNoise{0.003, 0.001});
  sensor.pose_sigma = {0.004, 0.01};
  BeliefGrid grid(kCube);
  const Eigen::Vector3d target(0.005, 0.005, 0.005);
  FrameIntegrator(sensor).integrate(grid, one_reading(0.5),
                                    look_at(target - Eigen::Vector3d(0.5, 0, 0), target));
  const auto belief = grid.belief({0, 0, 0});
  ASSERT_TRUE(belief.has_value());
  const double axial = 1 / (0.003 * 0.003 + 0.004 * 0.004);
  const double lateral = 1 / (0.001 * 0.001 + 0.004 * 0.004 + 0.005 * 0.005);
  EXPECT_NEAR(belief->information[0], axial, 1e-6 * axial);
  EXPECT_NEAR(belief->information[1], lateral, 1e-6 * lateral);
  EXPECT_NEAR(belief->information[2], lateral, 1e-6 * lateral);
}

TEST(Beliefs, OneFramesPoseMayBeWorseThanTheOthers) {
  const Eigen::Vector3d target(0.005, 0.005, 0.005);
  const Pose pose = look_at(target - Eigen::Vector3d(0.5, 0, 0), target);
  Sensor sensor = one_pixel(ConstantNoise{0.003, 0.001});
  sensor.pose_sigma = {0.001, 0.002};
  FrameIntegrator integrator(sensor);
  BeliefGrid grid(kCube);
  EXPECT_THROW(integrator.integrate(grid, one_reading(0.5), pose, {-1e-3, 0}), Error);
  EXPECT_THROW(integrator.integrate(grid, one_reading(0.5), pose, {0, std::nan("")}), Error);
  EXPECT_TRUE(grid.views().empty());
  integrator.integrate(grid, one_reading(0.5), pose, {0.004, 0.01});
  integrator.integrate(grid, one_reading(0.5), pose);

  Sensor both = sensor;
  both.pose_sigma = {std::hypot(0.001, 0.004), std::hypot(0.002, 0.01)};
  BeliefGrid expected(kCube);
  FrameIntegrator(both).integrate(expected, one_reading(0.5), pose);
  FrameIntegrator(sensor).integrate(expected, one_reading(0.5), pose);
  EXPECT_EQ(grid.content_hash(), expected.content_hash());
}

TEST(Beliefs, ExactReadingsOfOnePointFuseToIt) {
  const Eigen::Vector3d target(0.0437, -0.0281, 0.0119);
  GridConfig config = kCube;
  config.T_world_grid =
      Pose(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 1, 2).normalized()).toRotationMatrix(),
           Eigen::Vector3d(0.01, -0.02, 0.005));
  BeliefGrid grid(config);
  FrameIntegrator integrator(one_pixel(ShotNoise{}));
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d eye =
        target + Eigen::Vector3d(std::cos(i * 1.7), std::sin(i * 1.7), std::cos(i * 0.9)) * 0.4;
    integrator.integrate(grid, one_reading((target - eye).norm()), look_at(eye, target));
  }
  const Eigen::Vector3d p_grid = config.T_world_grid.inverse() * target;
  const Index3 voxel{static_cast<int>(std::floor(p_grid.x() / 0.01)),
                     static_cast<int>(std::floor(p_grid.y() / 0.01)),
                     static_cast<int>(std::floor(p_grid.z() / 0.01))};
  const auto belief = grid.belief(voxel);
  ASSERT_TRUE(belief.has_value());
  EXPECT_EQ(belief->hits, 30U);
  const Eigen::Vector3d center((voxel.x + 0.5) * 0.01, (voxel.y + 0.5) * 0.01,
                               (voxel.z + 0.5) * 0.01);
  const auto& eta = belief->information_vector;
  const Eigen::Vector3d fused = center + belief->information_matrix().matrix().inverse() *
                                             Eigen::Vector3d(eta[0], eta[1], eta[2]);
  EXPECT_LT((fused - p_grid).norm(), 1e-6);  // the depth itself is in single precision
}

TEST(Beliefs, IncidenceComesFromTheNeighbourhood) {
  Sensor sensor = small_sensor(64, 48);
  sensor.noise = ShotNoise{};
  sensor.camera.cx = 32;
  sensor.camera.cy = 24;
  const GridConfig config{0.1, {{-1, -1, 0}, {1, 1, 1.5}}, {}, 0.01};
  const auto axial_sigma = [&](const DepthFrame& frame) {
    BeliefGrid grid(config);
    DepthFrame alone{64, 48, frame.depth};
    FrameIntegrator(sensor).integrate(grid, alone, Pose{});
    // All readings in the voxel share cosθ up to the perspective; along z only the axial part
    // counts.
    const auto belief = grid.belief({0, 0, 5});
    EXPECT_TRUE(belief.has_value());
    return std::sqrt(belief->hits / static_cast<double>(belief->information[2]));
  };
  for (const double degrees : {0.0, 30.0, 50.0, 65.0, 75.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    // Tilted about y, so that z = 0.52 + tan(angle) x; few pixels lie in the voxel [0, 0.1]² x
    // [0.5, 0.6].
    BeliefGrid grid(config);
    const DepthFrame frame = see_plane(sensor, 0.52, std::tan(angle));
    FrameIntegrator(sensor).integrate(grid, frame, Pose{});
    const auto belief = grid.belief({0, 0, 5});
    ASSERT_TRUE(belief.has_value());
    // The same sum with the analytic cosine, on the pixels whose readings lie in that voxel.
    SymmetricMatrix3 expected;
    std::uint32_t hits = 0;
    const Eigen::Vector3d normal = Eigen::Vector3d(-std::tan(angle), 0, 1).normalized();
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        const Eigen::Vector3d ray = sensor.camera.ray(u, v);
        const Eigen::Vector3d p = ray * double{frame.at(u, v)};
        if (!(Eigen::Vector3d(0, 0, 0.5).array() <= p.array()).all() ||
            !(p.array() < Eigen::Vector3d(0.1, 0.1, 0.6).array()).all()) {
          continue;
        }
        const Eigen::Vector3d d = ray.normalized();
        expected += measurement_information(d, sensor.sigmas(p.norm(), std::abs(normal.dot(d))));
        ++hits;
      }
    }
    EXPECT_EQ(belief->hits, hits) << degrees;
    EXPECT_GT(hits, 3U);
    EXPECT_NEAR(belief->information[2], expected.zz, 2e-4 * expected.zz) << degrees;
    EXPECT_NEAR(belief->information[0], expected.xx, 2e-4 * expected.xx) << degrees;
  }

  // Where a pixel has no neighbours its surface counts as frontal; so it does beside a jump on all
  // sides.
  const DepthFrame tilted = see_plane(sensor, 0.52, std::tan(1.2));
  DepthFrame sparse = tilted, jumps = tilted;
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      if (u % 2 == 0 && v % 2 == 0) continue;
      const auto i = static_cast<std::size_t>(v * 64 + u);
      sparse.depth[i] = DepthFrame::kInvalid;
      jumps.depth[i] *= 3.0F;
    }
  }
  const double frontal = sensor.sigmas(0.55, 1.0).axial;
  EXPECT_NEAR(axial_sigma(sparse), frontal, 0.1 * frontal);
  EXPECT_NEAR(axial_sigma(jumps), frontal, 0.1 * frontal);
  EXPECT_GT(axial_sigma(tilted), 1.4 * frontal);
}

// Readings in the last voxels of a column or row still get their incidence from one side.
TEST(Beliefs, OneSidedAtTheImageBorder) {
  Sensor sensor = small_sensor(2, 2);
  sensor.camera.fx = sensor.camera.fy = 220;
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.noise = ShotNoise{};
  BeliefGrid grid({0.1, {{-1, -1, 0}, {1, 1, 1.5}}, {}, 0.01});
  const double slope = std::tan(1.0);
  FrameIntegrator(sensor).integrate(grid, see_plane(sensor, 0.52, slope), Pose{});
  const auto belief = grid.belief({0, 0, 5});
  ASSERT_TRUE(belief.has_value());
  EXPECT_EQ(belief->hits, 4U);
  const double expected = sensor.sigmas(0.52, std::cos(1.0)).axial;
  EXPECT_NEAR(std::sqrt(4.0 / static_cast<double>(belief->information[2])), expected,
              0.01 * expected);
}

TEST(Beliefs, StayWithAVoxelThatTurnsFreeAndGoOnLater) {
  const ConstantNoise noise{0.002, 0.002};
  BeliefGrid grid(kCube);
  FrameIntegrator integrator(one_pixel(noise));
  const Pose pose = look_at({0.005, 0.005, -0.5}, {0.005, 0.005, 0.0});
  const auto see = [&](double depth) { integrator.integrate(grid, one_reading(depth), pose); };
  see(0.505);
  ASSERT_EQ(grid.state({0, 0, 0}), VoxelState::occupied);
  const auto first = grid.belief({0, 0, 0});
  see(0.575), see(0.575), see(0.575);  // 0.85 - 3 * 0.4 < 0
  EXPECT_EQ(grid.state({0, 0, 0}), VoxelState::free);
  EXPECT_EQ(grid.belief({0, 0, 0}), first);
  // It is no part of entropy_removed while it is free.
  const double with_it = grid.statistics().entropy_removed;
  see(0.505);
  EXPECT_EQ(grid.state({0, 0, 0}), VoxelState::occupied);
  const auto again = grid.belief({0, 0, 0});
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->hits, 2U);
  EXPECT_FLOAT_EQ(again->information[0], 2 * first->information[0]);
  EXPECT_GT(grid.statistics().entropy_removed, with_it);
}

// Incidence from the amplitude of a frame.

const GridConfig kBox{0.1, {{-1, -1, 0}, {1, 1, 1.5}}, {}, 0.01};

TEST(Amplitude, GivesTheCosineOfIncidence) {
  Sensor sensor = small_sensor(1, 1);
  sensor.camera.cx = sensor.camera.cy = 0;
  sensor.noise = ShotNoise{};
  const double t = 0.55;
  struct Case {
    double amplitude, cosine;
  };
  for (const auto& [amplitude, cosine] :
       {Case{1 / (t * t), 1.0}, Case{0.5 / (t * t), 0.5}, Case{0.2 / (t * t), 0.2},
        Case{0.01 / (t * t), kMinCosIncidence}, Case{7.0 / (t * t), 1.0},
        Case{0.0, kMinCosIncidence}, Case{-1.0, kMinCosIncidence},
        Case{std::nan(""), kMinCosIncidence}, Case{std::numeric_limits<double>::infinity(), 1.0}}) {
    BeliefGrid grid(kBox);
    const DepthFrame frame{1, 1, {static_cast<float>(t)}, {static_cast<float>(amplitude)}};
    EXPECT_EQ(FrameIntegrator(sensor).integrate(grid, frame, Pose{}).voxels_hit, 1U);
    const auto belief = grid.belief({0, 0, 5});
    ASSERT_TRUE(belief.has_value());
    const double sigma = sensor.sigmas(t, cosine).axial;
    EXPECT_NEAR(belief->information[2], 1 / (sigma * sigma), 1e-5 / (sigma * sigma)) << amplitude;
  }
}

TEST(Amplitude, ReplacesTheNeighbourhoodAndOnlyWhereThereIsOne) {
  Sensor sensor = small_sensor(48, 36);
  sensor.noise = ShotNoise{};
  // A frontal plane whose amplitudes say 60°.
  DepthFrame frame{48, 36, std::vector<float>(48 * 36, 0.55F)};
  const auto information = [&] {
    BeliefGrid grid(kBox);
    FrameIntegrator(sensor).integrate(grid, frame, Pose{});
    const auto belief = grid.belief({0, 0, 5});
    EXPECT_TRUE(belief.has_value());
    return belief ? static_cast<double>(belief->information[2]) / belief->hits : 0.0;
  };
  const double by_neighbourhood = information();
  const auto rays = sensor.camera.ray_table();
  const auto set_cosine = [&](double cosine) {
    frame.amplitude.clear();
    for (const Eigen::Vector3d& ray : rays) {
      frame.amplitude.push_back(static_cast<float>(cosine / (0.55 * ray).squaredNorm()));
    }
  };
  set_cosine(0.5);
  EXPECT_NEAR(information(), 0.5 * by_neighbourhood, 0.03 * by_neighbourhood);
  set_cosine(1.0);
  EXPECT_NEAR(information(), by_neighbourhood, 0.03 * by_neighbourhood);
  // One at full scale tells no angle: of a tilted plane, too, the neighbourhood does.
  frame.amplitude.clear();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    frame.depth[i] = static_cast<float>(0.55 / (1 + 0.5 * rays[i].x()));
  }
  const double of_tilted = information();
  set_cosine(0.3);
  EXPECT_LT(information(), 0.8 * of_tilted);
  frame.amplitude.assign(rays.size(), DepthFrame::kSaturated);
  EXPECT_EQ(information(), of_tilted);
}

TEST(Amplitude, OfAnotherSizeIsRefused) {
  const Sensor sensor = small_sensor(4, 3);
  BeliefGrid grid(kBox);
  FrameIntegrator integrator(sensor);
  for (const std::size_t size : {1U, 11U, 13U}) {
    const DepthFrame frame{4, 3, std::vector<float>(12, 0.5F), std::vector<float>(size, 1.0F)};
    expect_error(ErrorCode::invalid_argument, std::to_string(size) + " amplitudes",
                 [&] { integrator.integrate(grid, frame, Pose{}); });
    EXPECT_THROW((void)reading_bounds(sensor, frame, Pose{}), Error);
  }
  EXPECT_TRUE(grid.views().empty());
}

}  // namespace
}  // namespace viewgain
