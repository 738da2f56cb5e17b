// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "core/expect_error.hpp"
#include "mesh/shapes.hpp"
#include "surface_checks.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain {
namespace {

using test::area_of;
using test::good_normals;
using test::Noise;
using test::norm;
using test::plate_points;
using test::sphere_points;
using test::Topology;
using test::vec;

constexpr double kSpacing = 0.003;
constexpr double kRadius = 0.06;

const SurfaceConfig kConfig{.spacing = kSpacing};

Topology check_surface(const SurfaceMesh& mesh, const std::vector<OrientedPoint>& points) {
  return test::check_surface(mesh, points, kConfig);
}

void expect_topology(const Topology& topology, std::size_t components, std::size_t border_loops,
                     long euler) {
  EXPECT_EQ(topology.components, components);
  EXPECT_EQ(topology.border_loops, border_loops);
  EXPECT_EQ(topology.euler, euler);
}

bool same(const SurfaceMesh& a, const SurfaceMesh& b) {
  return a.vertices == b.vertices && a.normals == b.normals && a.triangles == b.triangles &&
         a.source == b.source;
}

TEST(SurfaceReconstruction, ExactLatticeBecomesAPlateWithOneBorder) {
  constexpr int kSide = 30;
  for (const double up : {1.0, -1.0}) {
    const auto points = plate_points(kSide, kSpacing, 0.1, up);
    const SurfaceMesh mesh = reconstruct_surface(points, kConfig);
    expect_topology(check_surface(mesh, points), 1, 1, 1);
    EXPECT_EQ(good_normals(mesh, points), 1.0);
    const double side = (kSide - 1) * kSpacing;
    EXPECT_NEAR(area_of(mesh), side * side, 0.01 * side * side);
    for (const auto& v : mesh.vertices) EXPECT_NEAR(v[2], 0.1, 1e-9);
  }
}

TEST(SurfaceReconstruction, LayersOfAThinPlateAreNotFused) {
  constexpr int kSide = 30;
  for (const double gap : {6.0, 4.5}) {  // spacings
    Noise noise(3);
    auto points = plate_points(kSide, kSpacing);
    const auto below = plate_points(kSide, kSpacing, -gap * kSpacing, -1);
    points.insert(points.end(), below.begin(), below.end());
    for (auto& p : points) p.position[2] += 0.2 * kSpacing * noise.normal();
    const SurfaceMesh mesh = reconstruct_surface(points, kConfig);
    expect_topology(check_surface(mesh, points), 2, 2, 2);
    EXPECT_GT(good_normals(mesh, points), 0.995);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const double z = points[mesh.source[v]].toward_free[2] > 0 ? 0 : -gap * kSpacing;
      EXPECT_NEAR(mesh.vertices[v][2], z, 0.4 * kSpacing);
    }
  }
}

TEST(SurfaceReconstruction, SmoothingTakesNoiseAway) {
  for (const double sigma : {0.3, 0.5}) {  // spacings
    const auto points = sphere_points(kRadius, kSpacing, sigma * kSpacing);
    const SurfaceMesh mesh = reconstruct_surface(points, kConfig);
    SurfaceConfig rough_config = kConfig;
    rough_config.smoothing_neighbors = 0;
    const SurfaceMesh rough = reconstruct_surface(points, rough_config);
    const auto rms = [](const SurfaceMesh& m) {
      double sum = 0;
      for (const auto& v : m.vertices) sum += std::pow(norm(v) - kRadius, 2);
      return std::sqrt(sum / static_cast<double>(m.vertices.size()));
    };
    expect_topology(check_surface(mesh, points), 1, 0, 2);
    EXPECT_GE(mesh.vertices.size(), points.size() * 98 / 100);
    EXPECT_GT(good_normals(mesh, points), sigma < 0.4 ? 0.99 : 0.9);
    EXPECT_NEAR(rms(rough), sigma * kSpacing, 0.1 * sigma * kSpacing);
    // A quadric through n points leaves about 2 σ / √n in its middle; n = 24.
    EXPECT_LT(rms(mesh), 0.5 * sigma * kSpacing);
  }
}

TEST(SurfaceReconstruction, OutliersGoAndNothingElse) {
  auto points = sphere_points(kRadius, kSpacing, 0.2 * kSpacing);
  const std::size_t good = points.size();
  // Single points off the surface, a clump of 30 in the middle, a lone point far away.
  Noise noise(11);
  for (int i = 0; i < 100; ++i) {
    OrientedPoint p = points[static_cast<std::size_t>(noise.uniform() * static_cast<double>(good))];
    for (double& x : p.position) x *= 1 + 2.5 * kSpacing / kRadius;
    points.push_back(p);
  }
  for (int i = 0; i < 30; ++i) {
    points.push_back({{kSpacing * (i % 6), kSpacing * (i / 6), 0}, {0, 0, 1}});
  }
  points.push_back({{1, 1, 1}, {0, 0, 1}});
  const SurfaceMesh mesh = reconstruct_surface(points, kConfig);
  const Topology topology = check_surface(mesh, points);
  EXPECT_EQ(topology.components, 1U);
  EXPECT_EQ(topology.border_edges, 0U);
  std::size_t kept_good = 0;
  for (const std::uint32_t source : mesh.source) {
    EXPECT_LT(source, good) << "an outlier is in the mesh";
    if (source < good) ++kept_good;
  }
  EXPECT_GE(kept_good, good * 99 / 100);
}

TEST(SurfaceReconstruction, FineAndCoarsePointsAreOneSurface) {
  // Below the equator a spacing apart, above four and more, said of each point or not.
  for (const double ratio : {4.0, 6.0}) {
    std::vector<OrientedPoint> mixed;
    for (const auto& p : sphere_points(kRadius, kSpacing, 0.2 * kSpacing)) {
      if (p.position[2] < 0) mixed.push_back(p);
    }
    const std::size_t fine = mixed.size();
    for (OrientedPoint p : sphere_points(kRadius, ratio * kSpacing, 0.2 * kSpacing)) {
      if (p.position[2] < 0) continue;
      p.spacing = ratio * kSpacing;
      mixed.push_back(p);
    }
    ASSERT_GT(mixed.size() - fine, 60U);
    const SurfaceMesh mesh = reconstruct_surface(mixed, kConfig);
    expect_topology(check_surface(mesh, mixed), 1, 0, 2);
    EXPECT_GE(mesh.vertices.size(), mixed.size() * 98 / 100);
    EXPECT_NEAR(area_of(mesh), 4 * std::numbers::pi * kRadius * kRadius, 0.03 * area_of(mesh));
    for (OrientedPoint& p : mixed) p.spacing = 0;
    EXPECT_GT(check_surface(reconstruct_surface(mixed, kConfig), mixed).border_loops, 0U);
  }
}

TEST(SurfaceReconstruction, HintsDecideTheSideByMajority) {
  auto points = sphere_points(kRadius, kSpacing, 0.2 * kSpacing, 0.3);
  const SurfaceMesh outward = reconstruct_surface(points, kConfig);
  ASSERT_FALSE(outward.vertices.empty());
  for (auto& p : points) {
    for (double& x : p.toward_free) x *= -1;
  }
  const SurfaceMesh inward = reconstruct_surface(points, kConfig);
  ASSERT_EQ(inward.vertices, outward.vertices);
  ASSERT_EQ(inward.triangles.size(), outward.triangles.size());
  for (std::size_t v = 0; v < inward.normals.size(); ++v) {
    EXPECT_LT((vec(inward.normals[v]) + vec(outward.normals[v])).norm(), 1e-12);
  }
  // A quarter is wrong and a quarter is not known: the rest still decides.
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 4 == 0) points[i].toward_free = {points[i].position};
    if (i % 4 == 1) points[i].toward_free = {0, 0, 0};
  }
  const SurfaceMesh mixed = reconstruct_surface(points, kConfig);
  check_surface(mixed, points);
  ASSERT_GT(mixed.vertices.size(), points.size() * 9 / 10);
  for (std::size_t v = 0; v < mixed.vertices.size(); ++v) {
    EXPECT_LT(vec(mixed.normals[v]).dot(vec(mixed.vertices[v])), 0);
  }
}

TEST(SurfaceReconstruction, DuplicatedPointsChangeNothing) {
  auto points = sphere_points(kRadius, kSpacing, 0.2 * kSpacing, -0.5);
  const SurfaceMesh once = reconstruct_surface(points, kConfig);
  ASSERT_FALSE(once.triangles.empty());
  const std::vector<OrientedPoint> copy = points;
  for (int i = 0; i < 3; ++i) points.insert(points.end(), copy.begin(), copy.end());
  EXPECT_TRUE(same(reconstruct_surface(points, kConfig), once));
}

TEST(SurfaceReconstruction, ManyCopiesOfOnePointAreNoSurface) {
  const std::vector<OrientedPoint> points(20000, OrientedPoint{{1, 2, 3}, {0, 0, 1}});
  EXPECT_TRUE(reconstruct_surface(points, kConfig).vertices.empty());
}

// Ties and roundings must not go by where memory was free, as it differs between two processes. The
// points are rough and thinned, so that CGAL closes and opens holes by the hundred.
TEST(SurfaceReconstruction, PlacesInMemoryDoNotMatter) {
  auto points = sphere_points(kRadius, 0.4 * kSpacing, 0.25 * kSpacing, -0.2);
  std::mt19937 random(5);
  std::erase_if(points, [&](const OrientedPoint&) { return random() % 3 == 0; });
  const SurfaceConfig config{.spacing = 0.4 * kSpacing, .smoothing_neighbors = 0};
  ASSERT_GT(points.size(), 10'000U);
  const SurfaceMesh first = reconstruct_surface(points, config);
  EXPECT_GT(first.triangles.size(), 10'000U);
  for (int layout = 0; layout < 3; ++layout) {
    // A heap with holes in no order, of the sizes in which CGAL asks for memory.
    std::vector<std::unique_ptr<char[]>> kept;
    for (int i = 0; i < 4000; ++i) {
      kept.push_back(std::make_unique<char[]>(1000 + random() % 120'000));
    }
    std::shuffle(kept.begin(), kept.end(), random);
    kept.resize(kept.size() / 2);
    EXPECT_TRUE(same(reconstruct_surface(points, config), first)) << layout;
  }
}

TEST(SurfaceReconstruction, FarFromTheOriginAndInOtherUnits) {
  // The same shape in millimetres, and moved by 100 m.
  const auto points = sphere_points(kRadius, kSpacing, 0.3 * kSpacing, 0.0);
  const Topology here = check_surface(reconstruct_surface(points, kConfig), points);
  auto moved = points;
  for (auto& p : moved) p.position[0] += 100;
  EXPECT_EQ(check_surface(reconstruct_surface(moved, kConfig), moved).euler, here.euler);
  auto scaled = points;
  for (auto& p : scaled) {
    for (double& x : p.position) x *= 1000;
  }
  SurfaceConfig config = kConfig;
  config.spacing *= 1000;
  const SurfaceMesh mesh = reconstruct_surface(scaled, config);
  EXPECT_EQ(mesh.triangles.size(), reconstruct_surface(points, kConfig).triangles.size());
}

// Beyond what cells can be numbered for.
TEST(SurfaceReconstruction, PointsFarOutOfRangeAreOutliers) {
  auto points = sphere_points(kRadius, kSpacing);
  const SurfaceMesh expected = reconstruct_surface(points, kConfig);
  for (const double far : {1e18, 1e30, -1e300}) {
    points.push_back({{far, far, 0}, {0, 0, 1}});
    points.push_back({{0, far, 0}, {0, 0, 1}});
  }
  const SurfaceMesh mesh = reconstruct_surface(points, kConfig);
  EXPECT_EQ(mesh.vertices, expected.vertices);
  EXPECT_EQ(mesh.triangles, expected.triangles);
}

TEST(SurfaceReconstruction, TooFewPointsGiveAnEmptyMesh) {
  const auto points = sphere_points(kRadius, kSpacing);
  for (const std::size_t count : {0U, 1U, 2U, 3U, 39U}) {
    const std::vector<OrientedPoint> few(points.begin(),
                                         points.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_TRUE(reconstruct_surface(few, kConfig).triangles.empty()) << count;
  }
  // With no least size they are only too few for a triangle, or on a line.
  SurfaceConfig config = kConfig;
  config.min_component = 0;
  std::vector<OrientedPoint> line;
  for (int i = 0; i < 60; ++i) line.push_back({{i * kSpacing, 0, 0}, {0, 0, 1}});
  EXPECT_TRUE(reconstruct_surface(line, config).vertices.empty());
  line.resize(2);
  EXPECT_TRUE(reconstruct_surface(line, config).vertices.empty());
}

TEST(SurfaceReconstruction, BadInputIsRefused) {
  auto points = sphere_points(kRadius, kSpacing);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(static_cast<void>(reconstruct_surface(points, {.spacing = bad})), Error);
  }
  for (const double bad : {0.5 * kSpacing, -kSpacing, nan}) {
    points[7].spacing = bad;
    test::expect_error(ErrorCode::invalid_argument, "point 7",
                       [&] { static_cast<void>(reconstruct_surface(points, kConfig)); });
  }
  points[7].spacing = 0;
  points[5].position[1] = nan;
  test::expect_error(ErrorCode::invalid_argument, "point 5",
                     [&] { static_cast<void>(reconstruct_surface(points, kConfig)); });
}

}  // namespace
}  // namespace viewgain
