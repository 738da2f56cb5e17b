// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/boundary.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/expect_error.hpp"
#include "surface_shapes.hpp"

namespace viewgain {
namespace {

using test::border_by_counting;
using test::cylinder_sheet;
using test::Edge;
using test::expect_error;
using test::plane_sheet;
using test::vertex_position;

constexpr double kRight = std::numbers::pi / 2;

std::map<Edge, BoundaryClass> class_of_edges(const std::vector<BoundaryRun>& runs) {
  std::map<Edge, BoundaryClass> classes;
  for (const BoundaryRun& run : runs) {
    EXPECT_EQ(run.vertices.size(), run.triangles.size() + (run.closed ? 0U : 1U));
    for (std::size_t i = 0; i < run.triangles.size(); ++i) {
      const Edge edge{run.vertices[i], run.vertices[(i + 1) % run.vertices.size()]};
      EXPECT_TRUE(classes.emplace(edge, run.boundary_class).second) << "an edge is in two runs";
    }
  }
  return classes;
}

Pose rolled(const Pose& pose, double angle) {
  return pose *
         Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {0, 0, 0});
}

// A camera at this azimuth about -y and elevation, looking at the origin from 0.4 m.
Pose camera_at(double azimuth, double elevation) {
  return look_at(
      0.4 * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation),
                            -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)),
      Eigen::Vector3d::Zero());
}

std::vector<BoundaryRun> runs_of(const SurfaceMesh& surface, const std::vector<Pose>& views,
                                 const BoundaryConfig& config = {}) {
  return boundary_runs(surface, boundary_loops(surface), views, sensor_preset("sr4000"), config);
}

// The sides of a cylinder sheet: 0 low azimuth, 1 high azimuth, 2 high z, 3 low z.
std::size_t side_of(const SurfaceMesh& surface, const Edge& edge, double height) {
  const Eigen::Vector3d p = vertex_position(surface, edge.first);
  const Eigen::Vector3d q = vertex_position(surface, edge.second);
  if (std::abs(p.z() - q.z()) > 1e-9) return p.x() < 0 ? 0 : 1;
  EXPECT_NEAR(std::abs(p.z()), height / 2, 1e-12);
  return p.z() > 0 ? 2 : 3;
}

TEST(Boundaries, EveryBorderEdgeIsInOneLoopAndOneRun) {
  std::size_t cases = 0;
  std::size_t pinched = 0;
  std::size_t neighbors = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const double share = 0.02 + 0.4 * test::hashed_uniform(seed, 1'000'000);
    const SurfaceMesh surface = test::without_faces(
        test::closed_sphere(0.1, 16),
        [&](std::size_t face) { return test::hashed_uniform(seed, face) < share; });
    const std::set<Edge> border = border_by_counting(surface);
    const auto loops = boundary_loops(surface);
    std::set<Edge> looped;
    std::map<std::uint32_t, int> visits;
    for (const BoundaryLoop& loop : loops) {
      ASSERT_EQ(loop.vertices.size(), loop.triangles.size());
      ASSERT_GE(loop.vertices.size(), 3U);
      for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
        const Edge edge{loop.vertices[i], loop.vertices[(i + 1) % loop.vertices.size()]};
        EXPECT_TRUE(looped.insert(edge).second);
        const auto& t = surface.triangles[loop.triangles[i]];
        const auto at = std::find(t.begin(), t.end(), edge.first) - t.begin();
        ASSERT_LT(at, 3);
        EXPECT_EQ(t[static_cast<std::size_t>((at + 1) % 3)], edge.second);
        ++visits[edge.first];
      }
    }
    EXPECT_EQ(looped, border);
    for (const auto& [vertex, count] : visits) pinched += count > 1;

    BoundaryConfig config;
    config.min_run_length = 0.05 * test::hashed_uniform(seed, 2'000'000);
    const std::vector<Pose> views{camera_at(0, 0), camera_at(2, 0.5), camera_at(4, -0.5)};
    const auto runs = runs_of(surface, views, config);
    const auto classes = class_of_edges(runs);
    EXPECT_EQ(classes.size(), border.size());
    for (const auto& [edge, boundary_class] : classes) EXPECT_TRUE(border.contains(edge));
    std::map<Edge, BoundaryClass> first_edges;
    for (const BoundaryRun& run : runs) {
      first_edges[{run.vertices[0], run.vertices[1]}] = run.boundary_class;
    }
    for (const BoundaryRun& run : runs) {
      if (run.closed) continue;
      EXPECT_GE(run.length, config.min_run_length);
      // What begins where this ends is of another class.
      const auto& around = loops[run.loop].vertices;
      if (visits[run.vertices.back()] > 1) continue;
      const auto end = std::find(around.begin(), around.end(), run.vertices.back());
      const Edge next{*end, end + 1 == around.end() ? around.front() : *(end + 1)};
      ASSERT_TRUE(first_edges.contains(next));
      EXPECT_NE(first_edges[next], run.boundary_class);
      ++neighbors;
    }
    ++cases;
  }
  EXPECT_EQ(cases, 30U);
  EXPECT_GT(pinched, 100U);
  EXPECT_GT(neighbors, 100U);
}

TEST(BoundaryLoops, RefuseWhatIsNoSurface) {
  const auto invalid = ErrorCode::invalid_argument;
  SurfaceMesh surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  surface.normals.assign(5, {0, 0, 1});
  surface.triangles = {{0, 1, 5}};
  expect_error(invalid, "vertex 5", [&] { (void)boundary_loops(surface); });
  surface.triangles = {{0, 1, 2}, {0, 1, 3}};
  expect_error(invalid, "0 and 1", [&] { (void)boundary_loops(surface); });
  surface.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  expect_error(invalid, "0 and 1", [&] { (void)boundary_loops(surface); });
  surface.triangles = {{2, 2, 3}};
  expect_error(invalid, "2 and 2", [&] { (void)boundary_loops(surface); });
  surface.triangles.clear();
  surface.normals.pop_back();
  expect_error(invalid, "normals: 4", [&] { (void)boundary_loops(surface); });
}

TEST(BoundaryRuns, AHalfCylindersSidesAreNamedByTheCamerasAxes) {
  using enum BoundaryClass;
  // Camera turned by quarter turns: what was up is then left, and so on.
  const std::array<std::array<BoundaryClass, 4>, 4> expected{{{left, right, top, bottom},
                                                              {bottom, top, left, right},
                                                              {right, left, bottom, top},
                                                              {top, bottom, right, left}}};
  std::size_t cases = 0;
  for (const double half_angle : {kRight, kRight / 2}) {
    const SurfaceMesh surface = cylinder_sheet(0.1, 0.12, half_angle, 0.005);
    const std::set<Edge> border = border_by_counting(surface);
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
      for (const double more : {-0.35, 0.0, 0.35}) {
        for (const double azimuth : {-0.25, 0.0, 0.25}) {
          for (const double elevation : {-0.2, 0.0, 0.2}) {
            // The conormals of a whole half cylinder's sides point away from a frontal camera.
            if (half_angle == kRight && (azimuth != 0 || elevation != 0)) continue;
            const Pose view =
                rolled(camera_at(azimuth, elevation), static_cast<double>(quarter) * kRight + more);
            const auto runs = runs_of(surface, {view});
            EXPECT_EQ(runs.size(), 4U);
            const auto classes = class_of_edges(runs);
            ASSERT_EQ(classes.size(), border.size());
            std::size_t wrong = 0;
            for (const auto& [edge, boundary_class] : classes) {
              wrong += boundary_class != expected[quarter][side_of(surface, edge, 0.12)];
            }
            EXPECT_EQ(wrong, 0U) << quarter << " " << more << " " << azimuth << " " << elevation;
            ++cases;
          }
        }
      }
    }
  }
  EXPECT_EQ(cases, 12U + 108U);
}

TEST(BoundaryRuns, LengthsAddUpAndTheLastViewWins) {
  const SurfaceMesh surface = plane_sheet(0.1, 0.06, 0.005);
  const Pose upright = look_at({0, 0, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  const Pose turned = rolled(upright, kRight);
  const Pose away = look_at({0, 0, 0.4}, {0, 0, 1}, Eigen::Vector3d::UnitY());
  struct Case {
    std::vector<Pose> views;
    std::uint32_t view;
    BoundaryClass upper;
  };
  const std::vector<Case> cases{
      {{upright}, 0, BoundaryClass::top},
      {{upright, turned}, 1, BoundaryClass::left},
      {{turned, upright}, 1, BoundaryClass::top},
      {{turned, upright, away}, 1, BoundaryClass::top},
      // None sees it, one faces it.
      {{away}, 0, BoundaryClass::top},
  };
  for (const Case& c : cases) {
    const auto runs = runs_of(surface, c.views);
    ASSERT_EQ(runs.size(), 4U);
    double length = 0;
    std::size_t upper = 0;
    for (const BoundaryRun& run : runs) {
      length += run.length;
      EXPECT_EQ(run.view, c.view);
      EXPECT_FALSE(run.closed);
      const Eigen::Vector3d p = vertex_position(surface, run.vertices[1]);
      if (p.y() > 0.0299 && std::abs(p.x()) < 0.0499) {
        EXPECT_EQ(run.boundary_class, c.upper);
        ++upper;
      }
    }
    EXPECT_NEAR(length, 0.32, 1e-12);
    EXPECT_EQ(upper, 1U);
  }
}

TEST(BoundaryRuns, AskWhetherThePointIsUnoccludedAndFallBackOnTheLastFacingView) {
  const SurfaceMesh surface = plane_sheet(0.1, 0.06, 0.005);
  const auto loops = boundary_loops(surface);
  const Pose upright = look_at({0, 0, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  const Pose behind = look_at({0, 0, -0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  const std::vector<Pose> views{upright, rolled(upright, kRight), behind};
  std::size_t asked = 0;
  const auto view_with = [&](const std::function<bool(std::size_t)>& sees_view) {
    const auto runs = boundary_runs(surface, loops, views, sensor_preset("sr4000"), {},
                                    [&](std::size_t view, const Eigen::Vector3d& point) {
                                      ++asked;
                                      EXPECT_LT(view, 2U) << "the one behind need not be asked";
                                      EXPECT_NEAR(point.z(), 0.0, 1e-12);
                                      return sees_view(view);
                                    });
    return runs.at(0).view;
  };
  EXPECT_EQ(view_with([](std::size_t) { return true; }), 1U);
  EXPECT_EQ(asked, loops[0].vertices.size());
  EXPECT_EQ(view_with([](std::size_t view) { return view == 0; }), 0U);
  EXPECT_EQ(view_with([](std::size_t) { return false; }), 1U);
  // The last view if none faces it.
  const std::vector<Pose> two{behind, rolled(behind, 0.1)};
  EXPECT_EQ(runs_of(surface, two).at(0).view, 1U);
}

TEST(BoundaryRuns, NeedRangeImageAndAngle) {
  const SurfaceMesh surface = plane_sheet(0.02, 0.02, 0.01);
  const Pose good = look_at({0, 0, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  const auto last_view = [&](const Pose& other, const BoundaryConfig& config = {}) {
    const auto runs = runs_of(surface, {good, other}, config);
    EXPECT_FALSE(runs.empty());
    return runs.at(0).view;
  };
  const auto tilted = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return look_at({0.5 * std::sin(a), 0, 0.5 * std::cos(a)}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  };
  EXPECT_EQ(last_view(tilted(75)), 1U);
  EXPECT_EQ(last_view(tilted(84)), 0U);
  BoundaryConfig narrow;
  narrow.max_view_angle = 70 * std::numbers::pi / 180;
  EXPECT_EQ(last_view(tilted(75), narrow), 0U);
  EXPECT_EQ(last_view(look_at({0, 0, 0.1}, {0, 0, 0}, {0, 1, 0})), 0U) << "too near";
  EXPECT_EQ(last_view(look_at({0, 0, 5.5}, {0, 0, 0}, {0, 1, 0})), 0U) << "too far";
  EXPECT_EQ(last_view(look_at({0.2, 0, 0.4}, {0.2, 0, 0}, {0, 1, 0})), 0U) << "beside the image";
}

TEST(BoundaryRuns, ShortOnesJoinTheirLongerNeighbour) {
  // A bite of one cell out of the middle of the upper side: its flanks are left and right.
  SurfaceMesh surface = plane_sheet(0.1, 0.06, 0.01);
  surface = test::without_faces(surface, [](std::size_t f) { return f / 2 == 54; });
  const Pose view = look_at({0, 0, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  EXPECT_EQ(runs_of(surface, {view}).size(), 8U);
  BoundaryConfig config;
  config.min_run_length = 0.015;
  const auto runs = runs_of(surface, {view}, config);
  ASSERT_EQ(runs.size(), 4U);
  double length = 0;
  for (const BoundaryRun& run : runs) {
    length += run.length;
    if (run.boundary_class == BoundaryClass::top) {
      EXPECT_NEAR(run.length, 0.12, 1e-12);
    }
  }
  EXPECT_NEAR(length, 0.34, 1e-12);
  EXPECT_EQ(class_of_edges(runs).size(), 34U);

  config.min_run_length = 0.09;
  std::set<BoundaryClass> left_over;
  for (const BoundaryRun& run : runs_of(surface, {view}, config)) {
    left_over.insert(run.boundary_class);
    EXPECT_GE(run.length, 0.09);
  }
  EXPECT_EQ(left_over.size(), 2U);
  config.min_run_length = 1;
  const auto whole = runs_of(surface, {view}, config);
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_TRUE(whole[0].closed);
  EXPECT_EQ(whole[0].vertices.size(), 34U);
  EXPECT_NEAR(whole[0].length, 0.34, 1e-12);
}

TEST(BoundaryRuns, OfTwoNeighboursTheLongerTakesAShortOne) {
  const Pose view = look_at({0, 0, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  BoundaryConfig config;
  config.min_run_length = 0.015;
  // An L whose arm ends in a side of 10 mm, between 100 mm above and 50 mm below it; and mirrored.
  for (const bool mirrored : {false, true}) {
    SurfaceMesh surface = plane_sheet(0.1, 0.1, 0.01);
    surface = test::without_faces(
        surface, [&](std::size_t f) { return f / 20 < 9 && (f / 2 % 10 >= 5) != mirrored; });
    const auto runs = runs_of(surface, {view}, config);
    EXPECT_EQ(runs.size(), 5U);
    for (const BoundaryRun& run : runs) {
      const bool top = run.boundary_class == BoundaryClass::top;
      const bool bottom = run.boundary_class == BoundaryClass::bottom;
      const bool outer = (run.boundary_class == BoundaryClass::left) != mirrored;
      EXPECT_NEAR(run.length, top ? 0.11 : bottom ? 0.05 : outer ? 0.1 : 0.09, 1e-12);
    }
  }
}

TEST(BoundaryRuns, NameTheViewThatIsTheMostCommon) {
  const SurfaceMesh surface = plane_sheet(0.1, 0.06, 0.005);
  // The second view has only the last fifth or so of the sheet in its image.
  const auto runs = runs_of(surface, {look_at({0, 0, 0.4}, {0, 0, 0}, {0, 1, 0}),
                                      look_at({0.19, 0, 0.4}, {0.19, 0, 0}, {0, 1, 0})});
  ASSERT_EQ(runs.size(), 4U);
  for (const BoundaryRun& run : runs) {
    EXPECT_EQ(run.view, run.boundary_class == BoundaryClass::right ? 1U : 0U);
  }
}

TEST(BoundaryRuns, SmallHolesAreLeftOutAndLargerOnesAreNot) {
  SurfaceMesh surface = plane_sheet(0.1, 0.1, 0.01);
  surface = test::without_faces(surface, [](std::size_t f) {
    const std::size_t column = f / 2 % 10;
    const std::size_t row = f / 20;
    return (column == 1 && row == 1) || (column >= 4 && column < 8 && row >= 4 && row < 8);
  });
  const auto loops = boundary_loops(surface);
  ASSERT_EQ(loops.size(), 3U);
  const Pose view = look_at({0, 0, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitY());
  EXPECT_EQ(runs_of(surface, {view}).size(), 12U);
  BoundaryConfig config;
  config.min_loop_length = 0.1;
  const auto runs = runs_of(surface, {view}, config);
  EXPECT_EQ(runs.size(), 8U);
  std::size_t hole_runs = 0;
  for (const BoundaryRun& run : runs) {
    const Eigen::Vector3d p = vertex_position(surface, run.vertices[1]);
    if (std::abs(p.x()) > 0.0499 || std::abs(p.y()) > 0.0499) continue;
    ++hole_runs;
    EXPECT_NEAR(run.length, 0.04, 1e-12);
    // Over the upper rim of a hole the surface ends downwards.
    if (p.y() > 0.0299 && p.x() > -0.0099 && p.x() < 0.0299) {
      EXPECT_EQ(run.boundary_class, BoundaryClass::bottom);
    }
  }
  EXPECT_EQ(hole_runs, 4U);
}

TEST(BoundaryRuns, RefuseBadArguments) {
  const auto invalid = ErrorCode::invalid_argument;
  const SurfaceMesh surface = plane_sheet(0.1, 0.1, 0.02);
  expect_error(invalid, "at least one view is required", [&] { (void)runs_of(surface, {}); });
  Pose skewed;
  skewed.m[1] = 0.5;
  expect_error(invalid, "view 1", [&] { (void)runs_of(surface, {Pose(), skewed}); });
  BoundaryConfig config;
  config.min_run_length = -1;
  expect_error(invalid, "min_run_length", [&] { (void)runs_of(surface, {Pose()}, config); });
  config = {};
  config.min_loop_length = NAN;
  expect_error(invalid, "min_loop_length", [&] { (void)runs_of(surface, {Pose()}, config); });
  config = {};
  config.max_view_angle = 2;
  expect_error(invalid, "max_view_angle", [&] { (void)runs_of(surface, {Pose()}, config); });
}

}  // namespace
}  // namespace viewgain
