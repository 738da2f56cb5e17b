// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/frame_agreement.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

struct Taken {
  DepthFrame frame;
  Pose T_world_camera;
  PoseSigma sigma{};
};

// What becomes of frames that go into a map one after the other.
std::vector<FrameContradiction> agreement_of(const Sensor& sensor, const GridConfig& config,
                                             const std::vector<Taken>& all,
                                             std::optional<double> plane = {}) {
  BeliefGrid grid(config, sensor);
  IntegrationConfig integration;
  integration.support_plane = plane;
  FrameIntegrator integrator(sensor, integration, {1});
  FrameAgreement agreement(sensor, plane);
  for (const Taken& taken : all) {
    agreement.look(grid, taken.frame, taken.T_world_camera, taken.sigma);
    integrator.integrate(grid, taken.frame, taken.T_world_camera, taken.sigma);
  }
  return agreement.frames(grid);
}

Sensor sensor_of_a_wall() {
  Sensor sensor = test::small_sensor(64, 48);
  sensor.noise = ConstantNoise{0.002, 0.002};
  return sensor;
}

// Voxels that are larger than a pixel on the wall.
GridConfig grid_of_a_wall() { return {0.02, {{-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}}, {}, 0.01}; }

Pose beside(double x) { return {Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0, 0)}; }

TEST(FrameAgreement, ViewsOfOneSceneAgree) {
  const Sensor sensor = test::small_sensor(88, 72);
  std::vector<Taken> all;
  for (int i = 0; i < 8; ++i) {
    const Pose pose = test::ring_view(i);
    all.push_back({test::see_spheres(sensor, pose, test::three_spheres_in_a_room()), pose});
  }
  std::size_t readings = 0, others = 0;
  for (const FrameContradiction& frame : agreement_of(sensor, test::object_grid(64), all)) {
    readings += frame.readings;
    others += frame.others;
    EXPECT_EQ(frame.in_free, 0U);
    EXPECT_EQ(frame.seen_past, 0U);
    EXPECT_FALSE(frame.same_image_as);
  }
  EXPECT_GT(readings, 300U);
  EXPECT_GT(others, 200U);
}

// A wall that the second frame sees farther off: by less than the errors of both it is the same
// one, by more the second frame looks past the first one's readings. The gate is three standard
// deviations of the difference, half a pixel and 1 % of the range.
TEST(FrameAgreement, AWallThatIsFartherOffIsSeenPast) {
  const Sensor sensor = sensor_of_a_wall();
  const double gate = 3 * std::hypot(0.002, 0.002) + 0.5 / sensor.camera.fx + 0.01;
  std::size_t cases = 0;
  for (const double share : {0.0, 0.5, 0.8, 1.4, 2.0, 6.0}) {
    const auto frames = agreement_of(sensor, grid_of_a_wall(),
                                     {{test::see_plane(sensor, 1), beside(0)},
                                      {test::see_plane(sensor, 1 + share * gate), beside(0.05)}});
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_GT(frames[1].others, 100U);
    EXPECT_EQ(frames[1].share_seen_past(), share > 1 ? 1.0 : 0.0) << share;
    EXPECT_EQ(frames[0].others, 0U);
    ++cases;
  }
  EXPECT_EQ(cases, 6U);
}

// A wall that the second frame sees nearer lies in free space where a voxel on either side of it is
// free: from about two voxels on.
TEST(FrameAgreement, AWallThatIsNearerLiesInFreeSpace) {
  const Sensor sensor = sensor_of_a_wall();
  std::size_t cases = 0;
  for (const double nearer : {0.0, 0.004, 0.03, 0.1, 0.3}) {
    const auto frames = agreement_of(sensor, grid_of_a_wall(),
                                     {{test::see_plane(sensor, 1.005), beside(0)},
                                      {test::see_plane(sensor, 1.005 - nearer), beside(0.02)}});
    EXPECT_GT(frames[1].readings, 100U);
    if (nearer < 0.01) {
      EXPECT_EQ(frames[1].in_free, 0U) << nearer;
    } else {
      EXPECT_GT(frames[1].share_in_free(), 0.8) << nearer;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 5U);
}

// What later frames carve away lay in their free space, though it was not free before.
TEST(FrameAgreement, WhatIsCarvedAwayLaterCounts) {
  const Sensor sensor = sensor_of_a_wall();
  std::vector<Taken> all{{test::see_plane(sensor, 0.8), beside(0)}};
  for (int i = 0; i < 6; ++i) all.push_back({test::see_plane(sensor, 1.2), beside(0.01 * i)});
  const auto frames = agreement_of(sensor, grid_of_a_wall(), all);
  EXPECT_GT(frames[0].share_in_free(), 0.8);
  for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_EQ(frames[i].in_free, 0U) << i;
}

TEST(FrameAgreement, ErrorsThatAreDeclaredExplainADifference) {
  const Sensor exact = sensor_of_a_wall();
  const auto nearer_by = [](const Sensor& sensor, const PoseSigma& sigma) {
    return agreement_of(sensor, grid_of_a_wall(),
                        {{test::see_plane(sensor, 1.005), beside(0), sigma},
                         {test::see_plane(sensor, 0.955), beside(0.02), sigma}})[1]
        .share_in_free();
  };
  EXPECT_GT(nearer_by(exact, {}), 0.8);
  EXPECT_EQ(nearer_by(exact, {0.02, 0}), 0.0);
  Sensor of_pose = exact, of_scale = exact;
  of_pose.pose_sigma = {0.02, 0};
  of_scale.scale_sigma = 0.02;
  EXPECT_EQ(nearer_by(of_pose, {}), 0.0);
  EXPECT_EQ(nearer_by(of_scale, {}), 0.0);
}

// Frames of which each second one is off along the optical axis. What is declared counts by the
// standard deviation of a reading, 0.35 % of the range at most, and twice by poses and scale.
TEST(FrameAgreement, FramesThatLieBesideOneAnother) {
  const Sensor exact = test::small_sensor(88, 72);
  Sensor of_pose = exact;
  of_pose.pose_sigma = {0.01, 0};
  std::size_t cases = 0;
  for (const double off : {0.0, 0.004, 0.008}) {
    std::vector<Taken> all;
    for (int i = 0; i < 8; ++i) {
      const Pose pose = test::ring_view(i % 2 == 0 ? 0 : 1);
      const Pose stated(pose.rotation(), pose * Eigen::Vector3d(0, 0, i % 2 == 0 ? 0 : off));
      all.push_back({test::see_spheres(exact, pose, test::three_spheres_in_a_room()), stated});
    }
    const auto frames = agreement_of(exact, test::object_grid(64), all);
    const auto declared = agreement_of(of_pose, test::object_grid(64), all);
    EXPECT_EQ(frames[0].compared, 0U);
    ASSERT_GT(frames[1].compared, 100U);
    EXPECT_LE(frames[1].displacement, off + 5e-4) << off;
    EXPECT_GE(frames[1].displacement, 0.5 * off) << off;  // of surfaces that are seen from the side
    EXPECT_LE(frames[1].expected, 0.0035 * 2) << off;
    EXPECT_GT(declared[1].expected, 0.02);
    EXPECT_LT(declared[1].expected, 0.03);
    ++cases;
  }
  EXPECT_EQ(cases, 3U);
}

TEST(FrameAgreement, TheSameImageFromAnotherPlace) {
  const Sensor sensor = sensor_of_a_wall();
  const DepthFrame wall = test::see_plane(sensor, 1, 0.2),
                   other = test::see_plane(sensor, 1.1, 0.2);
  const auto frames =
      agreement_of(sensor, grid_of_a_wall(),
                   {{wall, beside(0)}, {other, beside(0)}, {wall, beside(0)}, {wall, beside(0.1)}});
  EXPECT_FALSE(frames[0].same_image_as);
  EXPECT_FALSE(frames[1].same_image_as);
  EXPECT_FALSE(frames[2].same_image_as);  // from the same place it may well be the same
  ASSERT_TRUE(frames[3].same_image_as);
  EXPECT_EQ(*frames[3].same_image_as, 0U);
}

// Readings of the table and of known obstacles carve but do not hit, so that they say nothing here.
TEST(FrameAgreement, WhatIsKnownIsLeftOut) {
  const Sensor sensor = sensor_of_a_wall();
  DepthFrame wall = test::see_plane(sensor, 1);
  const Pose down(Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitX()).toRotationMatrix(),
                  {0, 0, 2});
  const auto on_table = agreement_of(sensor, grid_of_a_wall(), {{wall, down}, {wall, down}}, 1.0);
  EXPECT_EQ(on_table[1].readings, 0U);
  wall.known_depth.assign(wall.depth.size(), 0.9F);
  const auto known = agreement_of(sensor, grid_of_a_wall(), {{wall, beside(0)}});
  EXPECT_EQ(known[0].readings, 0U);
}

// More readings than are kept: shares stay what they are.
TEST(FrameAgreement, ManyFramesAreThinned) {
  const Sensor sensor = sensor_of_a_wall();
  std::vector<Taken> all;
  for (int i = 0; i < 150; ++i) {
    all.push_back({test::see_plane(sensor, i % 30 == 29 ? 0.8 : 1.005), beside(0.0003 * i)});
  }
  const auto frames = agreement_of(sensor, grid_of_a_wall(), all);
  std::size_t contradicting = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_nearer = i % 30 == 29;
    EXPECT_EQ(frames[i].share_in_free() > 0.5, is_nearer) << i;
    EXPECT_LE(frames[i].in_free, frames[i].readings);
    contradicting += is_nearer ? 1 : 0;
  }
  EXPECT_EQ(contradicting, 5U);
}

TEST(FrameAgreement, WhatIsNoFrameIsRefused) {
  const Sensor sensor = sensor_of_a_wall();
  const BeliefGrid grid(grid_of_a_wall(), sensor);
  FrameAgreement agreement(sensor);
  EXPECT_TRUE(agreement.frames(grid).empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const PoseSigma sigma : {PoseSigma{-1, 0}, PoseSigma{0, nan}}) {
    test::expect_error(ErrorCode::invalid_argument, "pose_sigma must be at least 0 and finite",
                       [&] { agreement.look(grid, test::see_plane(sensor, 1), beside(0), sigma); });
  }
  EXPECT_TRUE(agreement.frames(grid).empty());
  DepthFrame wall = test::see_plane(sensor, 1);
  Pose bent = beside(0);
  bent.m[0] = 2;
  test::expect_error(ErrorCode::invalid_argument, "", [&] { agreement.look(grid, wall, bent); });
  wall.depth.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "",
                     [&] { agreement.look(grid, wall, beside(0)); });
  // An image that says nothing agrees with all.
  const DepthFrame empty{64, 48, std::vector<float>(64 * 48, DepthFrame::kInvalid)};
  agreement.look(grid, empty, beside(0));
  const auto frames = agreement.frames(grid);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].share_in_free(), 0.0);
  EXPECT_EQ(frames[0].share_seen_past(), 0.0);
}

}  // namespace
}  // namespace viewgain
