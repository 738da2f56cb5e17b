// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/expect_error.hpp"
#include "surface_shapes.hpp"
#include "viewgain/mesh/boundary.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::plane_sheet;
using test::vertex_position;

TEST(BoundaryLoops, ASheetHasOneThatRunsRoundWithTheSurfaceOnItsLeft) {
  const SurfaceMesh surface = plane_sheet(0.2, 0.1, 0.01);
  const auto loops = boundary_loops(surface);
  ASSERT_EQ(loops.size(), 1U);
  ASSERT_EQ(loops[0].vertices.size(), 60U);
  ASSERT_EQ(loops[0].triangles.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    const Eigen::Vector3d p = vertex_position(surface, loops[0].vertices[i]);
    const Eigen::Vector3d q = vertex_position(surface, loops[0].vertices[(i + 1) % 60]);
    const Eigen::Vector3d out = (q - p).cross(Eigen::Vector3d::UnitZ()).normalized();
    const Eigen::Vector3d beside = 0.5 * (p + q) + 1e-3 * out;
    EXPECT_TRUE(std::abs(beside.x()) > 0.1 || std::abs(beside.y()) > 0.05) << i;
  }
}

TEST(BoundaryLoops, ClosedAndEmptySurfacesHaveNone) {
  EXPECT_TRUE(boundary_loops(test::closed_sphere(0.1, 12)).empty());
  EXPECT_TRUE(boundary_loops(SurfaceMesh{}).empty());
}

TEST(BoundaryLoops, EachComponentHasItsOwn) {
  const SurfaceMesh one = plane_sheet(0.1, 0.1, 0.02);
  EXPECT_EQ(boundary_loops(test::joined(one, one, {0.5, 0, 0})).size(), 2U);
}

TEST(BoundaryLoops, AreSeparatedWhereFacesMeetInAVertexOnly) {
  // A bow tie, and a fan of three separate faces round vertex 0.
  SurfaceMesh surface;
  for (int i = 0; i < 7; ++i) {
    surface.vertices.push_back({std::cos(i), std::sin(i), 0});
    surface.normals.push_back({0, 0, 1});
  }
  surface.triangles = {{0, 1, 2}, {0, 3, 4}};
  auto loops = boundary_loops(surface);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_EQ(loops[0].vertices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(loops[1].vertices, (std::vector<std::uint32_t>{0, 3, 4}));
  surface.triangles.push_back({5, 6, 0});
  loops = boundary_loops(surface);
  ASSERT_EQ(loops.size(), 3U);
  for (const BoundaryLoop& loop : loops) EXPECT_EQ(loop.vertices.size(), 3U);
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
  expect_error(invalid, "4 normals", [&] { (void)boundary_loops(surface); });
}

}  // namespace
}  // namespace viewgain
