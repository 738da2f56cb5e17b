// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// What counts as visible under limits of reach.
#include "viewgain/planner_mesh/truth.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "apps/planner/planner_scene.hpp"
#include "core/expect_error.hpp"
#include "viewgain/planner/view_sight.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"

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
  const auto scene = std::make_shared<const SurfaceScene>(test::cube_mesh(kHalf));
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
  const auto scene = std::make_shared<const SurfaceScene>(test::cube_mesh(kHalf));
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
  const auto scene = std::make_shared<const SurfaceScene>(test::cube_mesh(kHalf));
  ReachRegion nowhere, farther;
  nowhere.shells.push_back({{5000, 0, 0}, 0, 1});
  farther.shells.push_back({{0, 0, 0}, 40, 41});
  for (const auto& [reach, share] :
       {std::pair(ReachRegion{}, 1.0 / 6), std::pair(nowhere, 1.0), std::pair(farther, 1.0 / 6)}) {
    const Truth truth(scene, sensor, from_the_side(reach), {});
    EXPECT_NEAR(truth.figures(seen_face(), {}).coverage_visible, share, 0.03);
  }
}

TEST(Truth, AListOfPosesCountsWhereItIsInReach) {
  ReachRegion list;
  list.poses = {look_at({-0.5, 0, 0}, {0, 0, 0})};
  EXPECT_NEAR(share_of_the_face(from_the_side(list)), 0.5, 0.02);
  list.boxes.push_back({{0, -1, -1}, {1, 1, 1}});  // not there
  EXPECT_NEAR(share_of_the_face(from_the_side(list)), 1, 1e-9);
}

// Boundaries are classed by views that see them: what is hidden from a view counts for nothing.

constexpr double kVoxel = 0.008;
constexpr std::size_t kFrames = 3;  // from each pose, so that points have enough hits
constexpr double kRoof = 0.2;       // height of what hides the plate from above [m]

// A plate under a larger one. View 0 looks at it from the side, view 1 from above.
class HiddenPlate : public testing::Test {
 protected:
  HiddenPlate()
      : sensor(sensor_preset("sr4000")),
        views{look_at({0.5, 0, 0.3}, {0, 0, 0}), look_at({0, 0, 0.62}, {0, 0, 0})},
        model(sensor, test::model_config(sensor, 0.25, kVoxel), nullptr, {}) {
    TriangleMesh mesh;
    test::add_plate(mesh, 0.1, 0.1, 0);
    test::add_plate(mesh, 0.15, 0.15, kRoof);
    const SimulatedSensor camera(std::make_shared<const SurfaceScene>(mesh), sensor, {});
    for (std::size_t i = 0; i < views.size(); ++i) {
      const DepthFrame frame = camera.acquire(views[i], i);
      (void)model.update({views[i], std::vector<DepthFrame>(kFrames, frame)});
    }
  }

  // Of the runs at the plate, and not at the roof, how many are classed by each pose's frames.
  [[nodiscard]] std::array<int, 2> views_of_plate_runs(bool by_sight) const {
    GenerationConfig config = default_generation(sensor, kVoxel);
    config.boundary.classes_by_sight = by_sight;
    CandidateGeneration generation(model, config, {});
    (void)generation.generate(views.back());
    std::array<int, 2> count{};
    for (const BoundaryRun& run : generation.estimated().runs) {
      if (model.surface().vertices[run.vertices[0]][2] < 0.5 * kRoof)
        ++count.at(run.view / kFrames);
    }
    return count;
  }

  Sensor sensor;
  std::vector<Pose> views;
  SurfaceModel model;
};

TEST_F(HiddenPlate, IsSeenFromTheSideAlone) {
  ViewSight sight(model.scene(), sensor, views, {});
  for (const double x : {-0.09, 0.0, 0.09}) {
    for (const double y : {-0.09, 0.0, 0.09}) {
      EXPECT_TRUE(sight.sees(0, {x, y, 0})) << x << ' ' << y;
      EXPECT_FALSE(sight.sees(1, {x, y, 0})) << x << ' ' << y;
      EXPECT_TRUE(sight.sees(1, {x, y, kRoof})) << x << ' ' << y;
    }
  }
  EXPECT_FALSE(sight.sees(1, {0, 0, 0.7}));  // behind the camera
  EXPECT_FALSE(sight.sees(1, {5, 0, 0}));    // outside the image
}

TEST_F(HiddenPlate, ItsBoundariesAreClassedByTheViewThatSeesThem) {
  const std::array<int, 2> by_image = views_of_plate_runs(false);
  const std::array<int, 2> by_sight = views_of_plate_runs(true);
  EXPECT_GT(by_image[1], 0);
  EXPECT_GT(by_sight[0], 0);
  EXPECT_EQ(by_sight[1], 0);
}

TEST(BoundaryGeneration, RefusesVoxelsWithoutASize) {
  for (const double spacing : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
    test::expect_error(ErrorCode::invalid_argument, "voxel size",
                       [&] { (void)default_boundary(test::half_sr4000(), spacing); });
  }
}

}  // namespace
}  // namespace viewgain
