// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/viewpoint_estimator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "core/expect_error.hpp"
#include "surface_shapes.hpp"

namespace viewgain {
namespace {

using Eigen::Vector3d;
using test::cylinder_sheet;
using test::expect_error;
using test::plane_sheet;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kDistance = 0.4;

const Sensor kSensor = sensor_preset("sr4000");
const Pose kFromAbove = look_at({0, 0, kDistance}, {0, 0, 0}, Vector3d::UnitY());
const Pose kFront = look_at({0, -kDistance, 0}, {0, 0, 0});

EstimatedViews estimate(const SurfaceMesh& surface, const Pose& view,
                        const EstimatorConfig& config = {}) {
  const std::vector<Pose> views{view};
  return estimate_views(surface, views, kSensor, kDistance, config);
}

// A config for meshes whose corners should not make runs of their own.
EstimatorConfig smooth_config() {
  EstimatorConfig config;
  config.boundary.min_run_length = 0.02;
  return config;
}

Vector3d optical_axis(const BoundaryCandidate& candidate) {
  return candidate.T_world_camera.rotation().col(2);
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void expect_looks_at_target(const BoundaryCandidate& c) {
  const Vector3d to_target = c.target - c.T_world_camera.translation();
  EXPECT_NEAR(to_target.norm(), c.distance, 1e-9);
  EXPECT_LT(angle_between(to_target, optical_axis(c)), 1e-9);
  EXPECT_LT(orthonormality_error(c.T_world_camera), 1e-12);
}

TEST(EstimateViews, LooksStraightAtACylinderBeyondItsBoundary) {
  const double radius = 0.1;
  std::size_t cases = 0;
  double farthest = 0;
  double worst = 0;
  for (const double noise : {0.0, 0.0003}) {
    for (std::uint64_t seed = 1; seed <= (noise > 0 ? 6U : 1U); ++seed) {
      const SurfaceMesh surface = cylinder_sheet(radius, 0.12, 70 * kDegree, 0.003, noise, seed);
      for (const double overlap : {0.5, 0.45, 0.4, 0.35, 0.3, 0.2}) {
        EstimatorConfig config = smooth_config();
        config.overlap = overlap;
        const EstimatedViews views = estimate(surface, kFront, config);
        EXPECT_EQ(views.runs.size(), 4U);
        for (const BoundaryCandidate& c : views.candidates) {
          expect_looks_at_target(c);
          const Vector3d true_normal(c.target.x(), c.target.y(), 0.0);
          worst = std::max(worst, angle_between(-optical_axis(c), true_normal));
          EXPECT_LT(angle_between(-optical_axis(c), true_normal), 5 * kDegree)
              << "noise " << noise << " seed " << seed << " overlap " << overlap << " "
              << boundary_class_name(c.boundary_class);
          const double azimuth = std::abs(std::atan2(c.target.x(), -c.target.y()));
          farthest = std::max(farthest, radius * (azimuth - 70 * kDegree));
          ++cases;
        }
      }
    }
  }
  EXPECT_GE(cases, 7U * 6U * 12U);
  EXPECT_GT(farthest, 0.045) << "half the radius, along the surface";
  EXPECT_LT(farthest, 0.062);
  RecordProperty("worst_degrees", std::to_string(worst / kDegree));
}

TEST(EstimateViews, APlaneIsLookedAtStraightWithTheOverlapThatIsAskedFor) {
  const SurfaceMesh surface = plane_sheet(0.3, 0.3, 0.005);
  std::size_t cases = 0;
  for (const double overlap : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
    // The image stands upright, on edge and across the boundary; +z leads to look_at's fall-back.
    for (const Vector3d& up : {Vector3d(0, 1, 0), Vector3d(0.5, 1, 0), Vector3d(1, 1, 0),
                               Vector3d(0.3, 0, 0), Vector3d(0, 0, 1)}) {
      EstimatorConfig config;
      config.overlap = overlap;
      config.region_depth = 0.13;
      config.up = up;
      const EstimatedViews views = estimate(surface, kFromAbove, config);
      ASSERT_EQ(views.runs.size(), 4U);
      EXPECT_EQ(views.candidates.size(), 20U);
      for (const BoundaryCandidate& c : views.candidates) {
        expect_looks_at_target(c);
        EXPECT_LT((optical_axis(c) + Vector3d::UnitZ()).norm(), 1e-9);
        EXPECT_NEAR(c.target.z(), 0.0, 1e-12);
        // Footprint on the plane, by rays; what lies before the run's side is known.
        const QuadraticPatch& patch = views.patches[c.patch];
        std::size_t known = 0;
        std::size_t rays = 0;
        for (int v = 0; v < kSensor.camera.height; v += 3) {
          for (int u = 0; u < kSensor.camera.width; u += 3) {
            const Vector3d ray = c.T_world_camera.rotation() * kSensor.camera.ray(u, v);
            const Vector3d eye = c.T_world_camera.translation();
            const Vector3d hit = eye - ray * (eye.z() / ray.z());
            known += (hit - patch.origin).dot(patch.axes.col(0)) < 0;
            ++rays;
          }
        }
        EXPECT_NEAR(static_cast<double>(known) / static_cast<double>(rays), overlap, 0.02);
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 7U * 5U * 20U);
}

TEST(EstimateViews, ExtrapolatesNoFartherThanTheRegionIsDeep) {
  EstimatorConfig config;
  config.overlap = 0.05;
  for (const double depth : {0.011, 0.0311, 0.0511}) {
    config.region_depth = depth;
    const EstimatedViews views = estimate(plane_sheet(0.3, 0.3, 0.005), kFromAbove, config);
    EXPECT_EQ(views.candidates.size(), 20U);
    for (const BoundaryCandidate& c : views.candidates) {
      const QuadraticPatch& patch = views.patches[c.patch];
      const double u = (c.target - patch.origin).dot(patch.axes.col(0));
      EXPECT_NEAR(u, patch.depth, 1e-9);
      EXPECT_LE(u, depth);
      EXPECT_GT(u, depth - 0.005);
    }
  }
}

TEST(EstimateViews, DoesNotWrapRoundASmallCylinder) {
  std::size_t sideways = 0;
  std::size_t bounded = 0;
  for (const double max_turn : {20 * kDegree, 40 * kDegree, 60 * kDegree}) {
    EstimatorConfig config = smooth_config();
    config.overlap = 0.05;
    config.max_turn = max_turn;
    for (const double radius : {0.012, 0.02, 0.03}) {
      const EstimatedViews views =
          estimate(cylinder_sheet(radius, 0.12, 80 * kDegree, 0.003), kFront, config);
      for (const BoundaryCandidate& c : views.candidates) {
        const QuadraticPatch& patch = views.patches[c.patch];
        const double turn = angle_between(-optical_axis(c), patch.normal(0, 0));
        EXPECT_LE(turn, max_turn + 1e-9);
        if (c.boundary_class == BoundaryClass::left || c.boundary_class == BoundaryClass::right) {
          ++sideways;
          bounded += turn > max_turn - 1e-6;
          // The true surface, too, has turned by about as much.
          const Vector3d edge_normal(patch.origin.x(), patch.origin.y(), 0.0);
          EXPECT_LE(angle_between(-optical_axis(c), edge_normal), max_turn + 6 * kDegree);
        }
      }
    }
  }
  EXPECT_EQ(sideways, 36U);
  EXPECT_GE(bounded, 12U) << "20 degrees always bind";
}

TEST(EstimateViews, MakesAllVariantsInOrder) {
  EstimatorConfig config;
  config.distances = {1.0, 1.5};
  config.tilts = {0.0, 0.3, -0.3};
  config.rolls = {0.0, 0.5, std::numbers::pi / 2};
  config.up = Vector3d(0.2, 1, 0.1);
  const EstimatedViews views = estimate(plane_sheet(0.1, 0.1, 0.005), kFromAbove, config);
  const std::size_t variants = 2 * (1 + 2 + 2) * 3;
  ASSERT_EQ(views.patches.size(), 8U);
  ASSERT_EQ(views.candidates.size(), 8 * variants);
  for (std::size_t i = 0; i < views.candidates.size(); ++i) {
    const BoundaryCandidate& c = views.candidates[i];
    const std::size_t variant = i % variants;
    EXPECT_EQ(c.patch, i / variants);
    EXPECT_EQ(c.run, views.run_of_patch[c.patch]);
    EXPECT_EQ(c.boundary_class, views.runs[c.run].boundary_class);
    EXPECT_EQ(c.nominal, variant == 0);
    EXPECT_EQ(c.target, views.candidates[i - variant].target);
    expect_looks_at_target(c);
    // Distances, then tilts, for each about v and then about u, then rolls.
    EXPECT_NEAR(c.distance, kDistance * config.distances[variant / 15], 1e-12);
    const std::size_t tilt = variant % 15 / 3;
    constexpr std::array<double, 5> kTilts{0.0, 0.3, 0.3, -0.3, -0.3};
    EXPECT_EQ(c.tilt, kTilts[tilt]);
    EXPECT_EQ(c.roll, config.rolls[variant % 3]);
    const QuadraticPatch& patch = views.patches[c.patch];
    const Vector3d axis = tilt % 2 == 1 ? patch.axes.col(1) : patch.axes.col(0);
    const Vector3d direction = Eigen::AngleAxisd(c.tilt, axis) * patch.axes.col(2);
    EXPECT_LT((optical_axis(c) + direction).norm(), 1e-9);
    // Image up: as near to `up` as it can be, then turned about the optical axis.
    const Pose level = look_at(c.T_world_camera.translation(), c.target, config.up);
    const Eigen::Matrix3d turn = level.rotation().transpose() * c.T_world_camera.rotation();
    EXPECT_LT((turn - Eigen::AngleAxisd(c.roll, Vector3d::UnitZ()).toRotationMatrix()).norm(),
              1e-12);
  }
}

TEST(EstimateViews, LongRunsGetSeveralPatches) {
  EstimatorConfig config;
  const SurfaceMesh surface = plane_sheet(0.2, 0.05, 0.005);
  for (const double length : {0.3, 0.1, 0.06, 0.021}) {
    config.patch_length = length;
    const EstimatedViews views = estimate(surface, kFromAbove, config);
    std::vector<std::size_t> of_run(views.runs.size(), 0);
    for (const std::uint32_t run : views.run_of_patch) ++of_run.at(run);
    ASSERT_EQ(views.runs.size(), 4U);
    for (std::size_t r = 0; r < 4; ++r) {
      const double expected = std::ceil(views.runs[r].length / length - 1e-9);
      EXPECT_EQ(static_cast<double>(of_run[r]), expected);
    }
    EXPECT_EQ(views.regions.size(), views.patches.size());
    EXPECT_EQ(views.run_of_patch.size(), views.patches.size());
  }
}

TEST(EstimateViews, AHoleIsALargerBoundaryOrNone) {
  SurfaceMesh surface = test::closed_sphere(0.1, 60);
  surface = test::without_faces(surface, [&](std::size_t f) {
    return test::vertex_position(surface, surface.triangles[f][0]).y() < -0.09;
  });
  EstimatorConfig config = smooth_config();
  const EstimatedViews views = estimate(surface, kFront, config);
  EXPECT_GE(views.runs.size(), 4U);
  for (const BoundaryCandidate& c : views.candidates) {
    EXPECT_GT(optical_axis(c).y(), 0.5) << "towards the hole";
    EXPECT_LT(std::abs(c.target.norm() - 0.1), 0.005);
  }
  // One closed run still knows its outward directions.
  config.boundary.min_run_length = 1;
  config.patch_length = 1;
  const EstimatedViews whole = estimate(surface, kFront, config);
  ASSERT_EQ(whole.runs.size(), 1U);
  EXPECT_TRUE(whole.runs[0].closed);
  EXPECT_EQ(whole.candidates.size(), 3U);
  config.boundary.min_loop_length = 1;
  EXPECT_TRUE(estimate(surface, kFront, config).candidates.empty());
}

TEST(EstimateViews, ClosedAndEmptySurfacesGiveNone) {
  for (const SurfaceMesh& surface : {test::closed_sphere(0.1, 20), SurfaceMesh{}}) {
    const EstimatedViews views = estimate(surface, kFront);
    EXPECT_TRUE(views.runs.empty());
    EXPECT_TRUE(views.patches.empty());
    EXPECT_TRUE(views.candidates.empty());
  }
}

TEST(EstimateViews, TinySurfacesAreNoTrouble) {
  SurfaceMesh triangle;
  triangle.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  triangle.normals.assign(3, {0, 0, 1});
  triangle.triangles = {{0, 1, 2}};
  const EstimatedViews views = estimate(triangle, kFromAbove);
  EXPECT_GE(views.candidates.size(), 3U);
  for (const BoundaryCandidate& c : views.candidates) {
    expect_looks_at_target(c);
    EXPECT_LT((optical_axis(c) + Vector3d::UnitZ()).norm(), 1e-9);
  }
  // A face without area and vertices without normals say nothing about outward.
  triangle.vertices[2] = {0.02, 0, 0};
  triangle.normals.assign(3, {0, 0, 0});
  EXPECT_TRUE(estimate(triangle, kFromAbove).candidates.empty());
}

TEST(EstimateViews, ComponentsDoNotMixAndThePredicateIsHeard) {
  const SurfaceMesh one = plane_sheet(0.08, 0.08, 0.005);
  const SurfaceMesh both = test::joined(one, one, {0.1, 0, 0});
  const EstimatedViews views = estimate(both, kFromAbove);
  EXPECT_EQ(views.runs.size(), 8U);
  ASSERT_EQ(views.regions.size(), 16U);
  for (std::size_t p = 0; p < views.regions.size(); ++p) {
    const bool second = views.runs[views.run_of_patch[p]].vertices[0] >= one.vertices.size();
    EXPECT_FALSE(views.regions[p].empty());
    for (const std::uint32_t v : views.regions[p]) EXPECT_EQ(v >= one.vertices.size(), second);
  }
  const std::vector<Pose> two{kFromAbove, look_at({0.01, 0, kDistance}, {0.01, 0, 0}, {1, 0, 0})};
  const auto nothing_in_the_second = [](std::size_t view, const Vector3d&) { return view == 0; };
  std::set<std::uint32_t> seen_by;
  for (const auto& run :
       estimate_views(both, two, kSensor, kDistance, {}, nothing_in_the_second).runs) {
    seen_by.insert(run.view);
  }
  EXPECT_EQ(seen_by, (std::set<std::uint32_t>{0}));
}

TEST(EstimateViews, RefusesBadArguments) {
  const auto invalid = ErrorCode::invalid_argument;
  const SurfaceMesh surface = plane_sheet(0.1, 0.1, 0.02);
  const std::vector<std::pair<std::string, std::function<void(EstimatorConfig&)>>> changes{
      {"overlap", [](auto& c) { c.overlap = 1.0; }},
      {"overlap", [](auto& c) { c.overlap = 0.0; }},
      {"patch_length", [](auto& c) { c.patch_length = 0; }},
      {"region_depth", [](auto& c) { c.region_depth = -1; }},
      {"max_turn", [](auto& c) { c.max_turn = -0.1; }},
      {"distances", [](auto& c) { c.distances.clear(); }},
      {"distances", [](auto& c) { c.distances = {0.0}; }},
      {"tilts", [](auto& c) { c.tilts.clear(); }},
      {"tilts", [](auto& c) { c.tilts = {1.6}; }},
      {"rolls", [](auto& c) { c.rolls.clear(); }},
      {"rolls", [](auto& c) { c.rolls = {std::numeric_limits<double>::infinity()}; }},
      {"up", [](auto& c) { c.up = Vector3d::Zero(); }},
  };
  for (const auto& [name, change] : changes) {
    EstimatorConfig config;
    change(config);
    expect_error(invalid, name, [&] { (void)estimate(surface, kFromAbove, config); });
  }
  EXPECT_EQ(changes.size(), 12U);
  const std::vector<Pose> views{kFromAbove};
  expect_error(invalid, "working_distance",
               [&] { (void)estimate_views(surface, views, kSensor, 0.0); });
  expect_error(invalid, "at least one view is required",
               [&] { (void)estimate_views(surface, {}, kSensor, kDistance); });
}

}  // namespace
}  // namespace viewgain
