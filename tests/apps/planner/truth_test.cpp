// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// What counts as visible under limits of reach.
#include "viewgain/planner_mesh/truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "apps/planner/planner_scene.hpp"

namespace viewgain {
namespace {

constexpr double kHalf = 0.1;  // of the box [m]

// A surface that is the box's face at +x alone.
SurfaceMesh seen_face() {
  SurfaceMesh surface;
  for (int i = -33; i <= 33; ++i) {
    for (int j = -33; j <= 33; ++j) surface.vertices.push_back({kHalf, 0.003 * i, 0.003 * j});
  }
  return surface;
}

VisibilityConfig from_the_side(const ReachRegion& reach) {
  VisibilityConfig config;
  config.distance = 0.4;
  config.start = look_at({0.5, 0, 0}, {0, 0, 0});
  config.reach = reach;
  return config;
}

// The share of the visible surface that the face is.
double share_of_the_face(const VisibilityConfig& config) {
  const auto scene = std::make_shared<const SurfaceScene>(test::box_mesh(kHalf));
  const Truth truth(scene, sensor_preset("sr4000"), config, {});
  return truth.figures(seen_face(), {}).coverage_visible;
}

TEST(Truth, ShellsThatLeaveOutTheWorkingDistanceShowWhatTheyShow) {
  ReachRegion farther, nearer, thin;
  farther.shells.push_back({{0, 0, 0}, 0.6, 0.9});
  nearer.shells.push_back({{0, 0, 0}, 0.25, 0.3});
  thin.shells.push_back({{0, 0, 0}, 0.7, 0.703});
  for (const ReachRegion& reach : {ReachRegion{}, farther, nearer, thin}) {
    // A sixth; samples near edges are nearer than 5 mm to it too.
    EXPECT_NEAR(share_of_the_face(from_the_side(reach)), 1.0 / 6, 0.03);
  }
}

TEST(Truth, CoveredAreaIsThatOfTheMesh) {
  const auto scene = std::make_shared<const SurfaceScene>(test::box_mesh(kHalf));
  VisibilityConfig config = from_the_side({});
  const double edge = 2 * kHalf;
  for (const double tolerance : {kCovered, 0.015}) {
    config.tolerance = tolerance;
    const Truth truth(scene, sensor_preset("sr4000"), config, {});
    // A face, and a strip of the four beside it.
    EXPECT_NEAR(truth.figures(seen_face(), {}).covered_area, edge * edge + 4 * edge * tolerance,
                1e-3);
    EXPECT_EQ(truth.figures({}, {}).covered_area, 0);
  }
}

TEST(Truth, HalfSpacesLeaveOutTheOtherSide) {
  // From the upper half nothing sees the underside; the lowest poses are left out or moved up.
  ReachRegion upper;
  upper.half_spaces.push_back({{0, 0, 1}, 0.05});
  EXPECT_NEAR(share_of_the_face(from_the_side(upper)), 1.0 / 5, 0.03);
}

TEST(Truth, NothingInReachLeavesWhatTheStartSees) {
  ReachRegion nowhere;
  nowhere.shells.push_back({{50, 0, 0}, 0, 1});
  EXPECT_NEAR(share_of_the_face(from_the_side(nowhere)), 1, 1e-9);
}

TEST(Truth, ASensorThatSeesFarTakesNoMoreMemoryAndNoLonger) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.max_range = 3e6;
  const auto scene = std::make_shared<const SurfaceScene>(test::box_mesh(kHalf));
  ReachRegion nowhere, farther;
  nowhere.shells.push_back({{5000, 0, 0}, 0, 1});
  farther.shells.push_back({{0, 0, 0}, 40, 41});
  for (const auto& [reach, share] :
       {std::pair(ReachRegion{}, 1.0 / 6), std::pair(nowhere, 1.0), std::pair(farther, 1.0 / 6)}) {
    const Truth truth(scene, sensor, from_the_side(reach), {});
    EXPECT_NEAR(truth.figures(seen_face(), {}).coverage_visible, share, 0.03);
  }
}

// A lens whose model turns back at 37° folds what lies beyond into the image.
TEST(Truth, WhatALensFoldsIntoTheImageIsNotVisible) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.camera.distortion = {-0.6, 0, 0, 0, 0};
  // The start alone counts. It looks past the box, which is at 51° from the axis and is folded to
  // where 6° are.
  VisibilityConfig config = from_the_side({});
  config.start = look_at({0.5, 0, 0}, {0, 0.62, 0});
  config.reach.shells.push_back({{50, 0, 0}, 0, 1});
  const Eigen::Vector3d face = config.start.inverse() * Eigen::Vector3d(kHalf, 0, 0);
  ASSERT_LT(sensor.camera.project(face).x(), sensor.camera.width);
  ASSERT_GT(sensor.camera.project(face).x(), 0);
  const auto scene = std::make_shared<const SurfaceScene>(test::box_mesh(kHalf));
  const Truth truth(scene, sensor, config, {});
  const double nothing = truth.figures(seen_face(), {}).coverage_visible;
  EXPECT_TRUE(std::isnan(nothing) || nothing == 0) << nothing;
}

TEST(Truth, AListOfPosesCountsWhereItIsInReach) {
  ReachRegion list;
  list.poses = {look_at({-0.5, 0, 0}, {0, 0, 0})};
  EXPECT_NEAR(share_of_the_face(from_the_side(list)), 0.5, 0.02);
  list.boxes.push_back({{0, -1, -1}, {1, 1, 1}});  // not there
  EXPECT_NEAR(share_of_the_face(from_the_side(list)), 1, 1e-9);
}

}  // namespace
}  // namespace viewgain
