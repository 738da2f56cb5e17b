// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/quality.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mesh/shapes.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

using Eigen::Vector3d;
using test::Noise;
using test::plate_mesh;
using test::sphere_mesh;
using Points = std::vector<std::array<double, 3>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vector3d vec(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }
std::array<double, 3> array_of(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// Distance to a triangle as the least over its corners, edges and inside, each tried without the
/// library's case distinctions.
double brute_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  double best = std::min({(p - a).norm(), (p - b).norm(), (p - c).norm()});
  for (const auto& [s, e] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const double t = (p - s).dot(e - s) / (e - s).squaredNorm();
    if (t > 0 && t < 1) best = std::min(best, (p - s - t * (e - s)).norm());
  }
  Eigen::Matrix<double, 3, 2> sides;
  sides << b - a, c - a;
  const Eigen::Vector2d uv = (sides.transpose() * sides).inverse() * (sides.transpose() * (p - a));
  if (uv.minCoeff() > 0 && uv.sum() < 1) best = std::min(best, (p - a - sides * uv).norm());
  return best;
}

TriangleMesh random_soup(std::size_t count, double size) {
  Noise noise(5);
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vector3d center(noise.uniform(), noise.uniform(), noise.uniform());
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(
          array_of(center + size * Vector3d(noise.normal(), noise.normal(), noise.normal())));
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

TEST(Quality, PointToSurfaceMatchesBruteForce) {
  const TriangleMesh mesh = random_soup(300, 0.05);
  const GroundTruth truth(mesh, 10);
  Noise noise(6);
  for (int i = 0; i < 500; ++i) {
    const Vector3d p(2 * noise.uniform() - 0.5, 2 * noise.uniform() - 0.5,
                     2 * noise.uniform() - 0.5);
    double expected = kInfinity;
    for (const auto& t : mesh.triangles) {
      expected =
          std::min(expected, brute_distance(p, vec(mesh.vertices[t[0]]), vec(mesh.vertices[t[1]]),
                                            vec(mesh.vertices[t[2]])));
    }
    const Points one{array_of(p)};
    EXPECT_NEAR(truth.error(one).rms, expected, 1e-12);
  }
}

TEST(Quality, SampleToPointMatchesBruteForce) {
  const GroundTruth truth(sphere_mesh(0.1, 16), 700);
  Noise noise(8);
  Points points;
  for (int i = 0; i < 300; ++i) {
    points.push_back({0.3 * noise.normal(), 0.1 * noise.normal(), 0.05 * noise.normal()});
  }
  points.insert(points.end(), 50, points[0]);
  const std::vector<double> distances = truth.distances_to(points);
  ASSERT_EQ(distances.size(), 700U);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    double expected = kInfinity;
    for (const auto& p : points) {
      expected = std::min(expected, (vec(p) - truth.samples()[i].position).norm());
    }
    EXPECT_NEAR(distances[i], expected, 1e-14);
  }
}

TEST(Quality, SampleToTrianglesMatchesBruteForce) {
  const GroundTruth truth(sphere_mesh(0.1, 16), 300);
  const TriangleMesh soup = random_soup(40, 0.05);
  TriangleMesh mesh = soup;  // with a triangle without area among the samples: left out
  const auto corner = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(array_of(truth.samples()[7].position));
  mesh.triangles.push_back({corner, corner, corner});
  const std::vector<double> distances = truth.distances_to(mesh);
  ASSERT_EQ(distances.size(), 300U);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    double expected = kInfinity;
    for (const auto& t : soup.triangles) {
      expected =
          std::min(expected, brute_distance(truth.samples()[i].position, vec(mesh.vertices[t[0]]),
                                            vec(mesh.vertices[t[1]]), vec(mesh.vertices[t[2]])));
    }
    EXPECT_NEAR(distances[i], expected, 1e-12);
  }
  for (const double none : truth.distances_to(TriangleMesh{})) EXPECT_EQ(none, kInfinity);
}

TEST(Quality, SamplesAreSpreadByArea) {
  // Two squares, one of nine times the other's area, cut into unequal triangles.
  TriangleMesh mesh = plate_mesh(0.3);
  for (const auto& v : plate_mesh(0.1).vertices) mesh.vertices.push_back({v[0], v[1], 1.0});
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  mesh.triangles.push_back({0, 0, 1});  // no area: no sample
  const GroundTruth truth(mesh, 10'000, 3);
  ASSERT_EQ(truth.samples().size(), 10'000U);
  std::size_t small = 0, left = 0;
  Vector3d mean = Vector3d::Zero();
  for (const SurfaceSample& s : truth.samples()) {
    EXPECT_NEAR((s.normal - Vector3d::UnitZ()).norm(), 0, 1e-12);
    if (s.position.z() > 0.5) {
      ++small;
      continue;
    }
    EXPECT_NEAR(s.position.z(), 0, 1e-12);
    EXPECT_TRUE(s.position.x() >= 0 && s.position.x() <= 0.3);
    EXPECT_TRUE(s.position.y() >= 0 && s.position.y() <= 0.3);
    mean += s.position;
    if (s.position.x() < 0.1) ++left;
  }
  EXPECT_NEAR(static_cast<double>(small), 1000, 2);
  mean /= static_cast<double>(10'000 - small);
  EXPECT_NEAR(mean.x(), 0.15, 0.003);
  EXPECT_NEAR(mean.y(), 0.15, 0.003);
  EXPECT_NEAR(static_cast<double>(left), 3000, 150);
}

TEST(Quality, SamplesDependOnTheSeedAlone) {
  const TriangleMesh mesh = sphere_mesh(0.1, 20);
  const GroundTruth a(mesh, 500, 1), b(mesh, 500, 1), c(mesh, 500, 2);
  std::size_t different = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_EQ(a.samples()[i].position, b.samples()[i].position);
    EXPECT_NEAR(a.samples()[i].position.norm(), 0.1, 0.002);
    EXPECT_GT(a.samples()[i].normal.dot(a.samples()[i].position.normalized()), 0.95);
    if (a.samples()[i].position != c.samples()[i].position) ++different;
  }
  EXPECT_GT(different, 490U);
}

TEST(Quality, PercentileAndRmsOverAPlate) {
  // 100 points at heights of 1 to 100 mm over the middle of a plate.
  const GroundTruth truth(plate_mesh(1.0), 10);
  Points points;
  double squares = 0;
  for (int i = 100; i >= 1; --i) {
    points.push_back({0.5, 0.5, 0.001 * i * (i % 2 == 0 ? 1 : -1)});
    squares += 1e-6 * i * i;
  }
  const ErrorStatistics error = truth.error(points);
  EXPECT_NEAR(error.rms, std::sqrt(squares / 100), 1e-12);
  EXPECT_NEAR(error.p95, 0.095, 1e-12);
}

TEST(Quality, CoverageOfAHalf) {
  // Points on the left half of the plate, 2 mm apart.
  const GroundTruth truth(plate_mesh(0.2), 10'000);
  Points points;
  for (int i = 0; i <= 50; ++i) {
    for (int j = 0; j <= 100; ++j) points.push_back({0.002 * i, 0.002 * j, 0});
  }
  const std::vector<double> distances = truth.distances_to(points);
  // Between points 2 mm apart a radius of r reaches √(r² - 1 mm²) past their last row.
  const auto share_up_to = [&](double x) {
    const auto count = std::count_if(truth.samples().begin(), truth.samples().end(),
                                     [&](const SurfaceSample& s) { return s.position.x() <= x; });
    return static_cast<double>(count) / static_cast<double>(distances.size());
  };
  for (const double radius : {0.0025, 0.005, 0.05}) {
    const double covered = coverage(distances, radius);
    EXPECT_LE(covered, share_up_to(0.1 + radius));
    EXPECT_GE(covered, share_up_to(0.1 + std::sqrt(radius * radius - 1e-6)));
    EXPECT_NEAR(covered, (0.1 + radius) / 0.2, 0.015);
  }
  EXPECT_EQ(coverage(distances, 1), 1.0);
  std::vector<std::uint8_t> left(distances.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = truth.samples()[i].position.x() < 0.1;
  EXPECT_EQ(coverage(distances, 0.0025, left), 1.0);
  EXPECT_TRUE(std::isnan(coverage(distances, 1, std::vector<std::uint8_t>(left.size(), 0))));
  EXPECT_EQ(coverage(std::vector<double>{0.001, 0.005, 0.0051, kInfinity}, 0.005), 0.5);
  EXPECT_THROW(static_cast<void>(coverage(distances, 1, std::vector<std::uint8_t>(3))), Error);
}

TEST(Quality, ConsistencyInClosedForm) {
  const GroundTruth truth(plate_mesh(1.0), 10);
  // Heights 0, 1, 2, 9 and 10.1 mm, with a variance along z of 1 mm²; one point beside the edge, at
  // 3 mm along -x, where the variance is 9 mm².
  const Points points{{0.5, 0.5, 0},     {0.5, 0.5, 0.001},  {0.5, 0.5, -0.002},
                      {0.5, 0.5, 0.009}, {0.5, 0.5, 0.0101}, {-0.003, 0.5, 0}};
  const std::vector<SymmetricMatrix3> covariances(points.size(), {9e-6, 4e-6, 1e-6, 0, 0, 0});
  const Consistency c = truth.consistency(points, covariances);
  EXPECT_EQ(c.points, 5U);
  EXPECT_EQ(c.outliers, 1U);
  EXPECT_NEAR(c.mean_clipped, (0 + 1 + 4 + 25 + 1) / 5.0, 1e-9);
  EXPECT_NEAR(c.median, 1, 1e-9);
  EXPECT_NEAR(c.above_9, 1 / 5.0, 1e-12);
}

TEST(Quality, WithoutPointsThereAreNoFigures) {
  const GroundTruth truth(plate_mesh(1.0), 10);
  const ErrorStatistics error = truth.error({});
  EXPECT_EQ(error.points, 0U);
  EXPECT_TRUE(std::isnan(error.rms) && std::isnan(error.p95));
  const Consistency none = truth.consistency({}, {});
  EXPECT_EQ(none.points, 0U);
  EXPECT_TRUE(std::isnan(none.mean_clipped) && std::isnan(none.median) && std::isnan(none.above_9));
  const Points far{{0, 0, 5}};
  const Consistency outlier =
      truth.consistency(far, std::vector<SymmetricMatrix3>(1, SymmetricMatrix3::identity()));
  EXPECT_EQ(outlier.outliers, 1U);
  EXPECT_TRUE(std::isnan(outlier.mean_clipped));
  const std::vector<double> distances = truth.distances_to(Points{});
  ASSERT_EQ(distances.size(), 10U);
  for (const double d : distances) EXPECT_EQ(d, kInfinity);
  EXPECT_EQ(coverage(distances, 1), 0.0);
  EXPECT_TRUE(std::isnan(coverage({}, 1)));
  EXPECT_TRUE(GroundTruth(plate_mesh(1.0), 0).samples().empty());
}

TEST(Quality, BadInputIsRefused) {
  TriangleMesh flat = plate_mesh(1.0);
  flat.triangles = {{0, 0, 1}};
  EXPECT_THROW(GroundTruth{flat}, Error);
  EXPECT_THROW(GroundTruth{TriangleMesh{}}, Error);
  TriangleMesh outside = plate_mesh(1.0);
  outside.triangles[1][2] = 4;
  EXPECT_THROW(GroundTruth{outside}, Error);
  TriangleMesh nan = plate_mesh(1.0);
  nan.vertices[3][1] = kNaN;
  EXPECT_THROW(GroundTruth{nan}, Error);

  const GroundTruth truth(plate_mesh(1.0), 10);
  const Points good{{0.5, 0.5, 0}}, bad{{0.5, kNaN, 0}};
  const std::vector<SymmetricMatrix3> one(1, SymmetricMatrix3::identity()), zero(1);
  EXPECT_THROW(static_cast<void>(truth.error(bad)), Error);
  EXPECT_THROW(static_cast<void>(truth.distances_to(bad)), Error);
  EXPECT_THROW(static_cast<void>(truth.consistency(good, {})), Error);
  EXPECT_THROW(static_cast<void>(truth.consistency(good, zero)), Error);
  EXPECT_EQ(truth.consistency(good, one).points, 1U);
}

}  // namespace
}  // namespace viewgain
