// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/patch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/expect_error.hpp"
#include "surface_shapes.hpp"

namespace viewgain {
namespace {

using Eigen::Vector3d;
using test::expect_error;
using test::hashed_normal;
using test::hashed_uniform;

// In [-1, 1).
double centred(std::uint64_t seed, std::uint64_t index) {
  return 2.0 * hashed_uniform(seed, index) - 1.0;
}

QuadraticPatch fit(const std::vector<Vector3d>& points) {
  return fit_patch(points, Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ());
}

// Columns by rows points, u in [-depth, 0], v in [-width / 2, width / 2], w = height(u, v).
template <typename Height>
std::vector<Vector3d> grid(int columns, int rows, double depth, double width, Height height) {
  std::vector<Vector3d> points;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double u = columns > 1 ? -depth * i / (columns - 1) : 0.0;
      const double v = rows > 1 ? width * (static_cast<double>(j) / (rows - 1) - 0.5) : 0.0;
      points.emplace_back(u, v, height(u, v));
    }
  }
  return points;
}

TEST(FitPatch, RecoversAnExactQuadricInAnyFrame) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    QuadraticPatch truth;
    truth.origin = {centred(seed, 1), centred(seed, 2), centred(seed, 3)};
    truth.axes =
        Eigen::Quaterniond(centred(seed, 4), centred(seed, 5), centred(seed, 6), centred(seed, 7))
            .normalized()
            .toRotationMatrix();
    for (std::size_t k = 0; k < 6; ++k) {
      truth.coefficients[k] = (k < 3 ? 10.0 : k < 5 ? 0.5 : 0.002) * centred(seed, 8 + k);
    }
    std::vector<Vector3d> points;
    double depth = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      const double u = -0.05 * hashed_uniform(seed, 100 + 2 * i);
      points.push_back(truth.point(u, 0.03 * centred(seed, 101 + 2 * i)));
      depth = std::max(depth, -u);
    }
    // The frame must be squared up from directions that are neither unit nor at right angles.
    const QuadraticPatch patch =
        fit_patch(points, truth.origin, 3.0 * truth.axes.col(0) + 0.7 * truth.axes.col(2),
                  0.2 * truth.axes.col(2));
    EXPECT_FALSE(patch.planar);
    EXPECT_LT((patch.axes - truth.axes).norm(), 1e-12);
    EXPECT_LT((patch.axes.transpose() * patch.axes - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_GT(patch.axes.determinant(), 0.0);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(patch.coefficients[k], truth.coefficients[k], 1e-9) << seed << " " << k;
    }
    EXPECT_LT(patch.rms, 1e-12);
    EXPECT_NEAR(patch.depth, depth, 1e-12);
  }
}

TEST(FitPatch, NormalIsAcrossTheTangents) {
  QuadraticPatch patch;
  patch.coefficients = {3, -2, 1, 0.4, -0.3, 0.1};
  const double h = 1e-5;
  for (const double u : {-0.1, 0.0, 0.2}) {
    for (const double v : {-0.2, 0.0, 0.1}) {
      const Vector3d du = patch.point(u + h, v) - patch.point(u - h, v);
      const Vector3d dv = patch.point(u, v + h) - patch.point(u, v - h);
      EXPECT_LT((patch.normal(u, v) - du.cross(dv).normalized()).norm(), 1e-9);
    }
  }
}

TEST(FitPatch, FallsBackToAPlaneThatThePointsDetermine) {
  const auto bowl = [](double u, double v) { return 5 * u * u + 3 * v * v + 0.1 * u; };
  // Two lines leave u² and u apart by a constant only; five points are too few.
  std::vector<std::vector<Vector3d>> layouts{grid(2, 20, 0.02, 0.06, bowl),
                                             grid(20, 2, 0.05, 0.02, bowl)};
  std::vector<Vector3d> five = grid(3, 3, 0.05, 0.05, bowl);
  five.erase(five.begin() + 2, five.end() - 3);
  ASSERT_EQ(five.size(), 5U);
  layouts.push_back(five);
  for (const auto& points : layouts) {
    const QuadraticPatch patch = fit(points);
    EXPECT_TRUE(patch.planar);
    const auto& k = patch.coefficients;
    EXPECT_TRUE(k[0] == 0 && k[1] == 0 && k[2] == 0);
    // Least squares: the residuals are orthogonal to 1, u and v.
    Vector3d moments = Vector3d::Zero();
    double sum = 0;
    for (const Vector3d& p : points) {
      const double residual = p.z() - patch.point(p.x(), p.y()).z();
      moments += residual * Vector3d(1, p.x(), p.y());
      sum += residual * residual;
    }
    EXPECT_LT(moments.norm(), 1e-14);
    EXPECT_NEAR(patch.rms, std::sqrt(sum / static_cast<double>(points.size())), 1e-15);
  }
  EXPECT_EQ(layouts.size(), 3U);
}

TEST(FitPatch, FallsBackToTheTangentPlaneWithoutEnoughPoints) {
  const auto slope = [](double u, double v) { return 0.5 * u + v; };
  const std::vector<std::vector<Vector3d>> layouts{
      {},
      {{-0.01, 0, 0.002}},
      {{-0.01, 0, 0.002}, {-0.02, 0.01, 0.001}},
      grid(20, 1, 0.05, 0, slope),
      grid(1, 20, 0, 0.05, slope),
      std::vector<Vector3d>(30, {-0.01, 0.02, 0.001}),
  };
  for (const auto& points : layouts) {
    const QuadraticPatch patch = fit(points);
    EXPECT_TRUE(patch.planar);
    EXPECT_EQ(patch.coefficients, (std::array<double, 6>{}));
    EXPECT_EQ(patch.normal(0.01, 0.02), Vector3d::UnitZ());
    EXPECT_TRUE(std::isfinite(patch.rms) && std::isfinite(patch.depth) && patch.depth >= 0);
  }
  EXPECT_EQ(layouts.size(), 6U);
}

TEST(FitPatch, TakesACurvatureThatIsKnownAndNoneThatNoiseFeigns) {
  std::size_t quadrics = 0;
  std::size_t strips = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::uint64_t index = 0;
    const auto rough = [&](double u, double) {
      return -5 * u * u + 1e-3 * hashed_normal(seed, index++);
    };
    // 50 mm deep with 1 mm of noise: a view 50 mm out is good to a few degrees.
    const QuadraticPatch wide = fit(grid(17, 21, 0.05, 0.06, rough));
    quadrics += !wide.planar;
    EXPECT_NEAR(wide.normal(0.05, 0).dot(Vector3d(0.5, 0, 1).normalized()), 1.0, 0.02);
    EXPECT_NEAR(wide.rms, 1e-3, 2e-4);
    // Three rows of it say nothing about the curvature across.
    const QuadraticPatch strip = fit(grid(3, 21, 0.006, 0.06, rough));
    strips += strip.planar;
    EXPECT_LT(std::acos(strip.normal(0.006, 0).z()), 0.4);
  }
  EXPECT_EQ(quadrics, 20U);
  EXPECT_GE(strips, 19U);
}

TEST(FitPatch, RefusesBadArguments) {
  const auto invalid = ErrorCode::invalid_argument;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vector3d> points{{0, 0, 0}};
  const std::vector<Vector3d> bad{{0, nan, 0}};
  const Vector3d x = Vector3d::UnitX();
  const Vector3d z = Vector3d::UnitZ();
  const Vector3d o = Vector3d::Zero();
  expect_error(invalid, "parallel", [&] { (void)fit_patch(points, o, -z, z); });
  expect_error(invalid, "parallel", [&] { (void)fit_patch(points, o, o, z); });
  expect_error(invalid, "parallel", [&] { (void)fit_patch(points, o, x, o); });
  expect_error(invalid, "finite", [&] { (void)fit_patch(bad, o, x, z); });
  expect_error(invalid, "finite", [&] { (void)fit_patch(points, {nan, 0, 0}, x, z); });
}

// Bellman and Ford over all faces until nothing changes.
std::vector<std::uint32_t> region_by_relaxation(const SurfaceMesh& surface,
                                                const std::vector<std::uint32_t>& seeds,
                                                double depth, double max_turn) {
  const auto normal = [&](std::uint32_t v) {
    return Vector3d(surface.normals[v][0], surface.normals[v][1], surface.normals[v][2]);
  };
  Vector3d mean = Vector3d::Zero();
  for (const std::uint32_t v : seeds) mean += normal(v);
  mean.normalize();
  const auto allowed = [&](std::uint32_t v) {
    return std::acos(std::clamp(normal(v).dot(mean), -1.0, 1.0)) < max_turn;
  };
  std::vector<double> distance(surface.vertices.size(), 1e9);
  for (const std::uint32_t v : seeds) {
    if (allowed(v)) distance[v] = 0;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& t : surface.triangles) {
      for (const std::uint32_t a : t) {
        for (const std::uint32_t b : t) {
          const double d =
              distance[a] +
              (test::vertex_position(surface, a) - test::vertex_position(surface, b)).norm();
          if (d <= depth && d < distance[b] && allowed(b)) {
            distance[b] = d;
            changed = true;
          }
        }
      }
    }
  }
  std::vector<std::uint32_t> region;
  for (std::uint32_t v = 0; v < distance.size(); ++v) {
    if (distance[v] <= depth) region.push_back(v);
  }
  return region;
}

TEST(GrowRegion, IsWhatRelaxationFinds) {
  std::size_t cases = 0;
  std::size_t sizes = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SurfaceMesh surface = test::cylinder_sheet(0.05, 0.1, 1.5, 0.004, 0.0003, seed);
    surface = test::without_faces(
        surface, [&](std::size_t f) { return hashed_uniform(seed + 99, f) < 0.2; });
    std::vector<std::uint32_t> seeds;
    for (std::uint64_t k = 0; k < 1 + seed % 4; ++k) {
      seeds.push_back(static_cast<std::uint32_t>(hashed_uniform(seed + 7, k) *
                                                 static_cast<double>(surface.vertices.size())));
    }
    const double depth = 0.01 + 0.03 * hashed_uniform(seed, 5);
    const double max_turn = 0.3 + 0.7 * hashed_uniform(seed, 6);
    const auto region = grow_region(surface, seeds, depth, max_turn);
    EXPECT_EQ(region, region_by_relaxation(surface, seeds, depth, max_turn));
    EXPECT_TRUE(std::is_sorted(region.begin(), region.end()));
    sizes += region.size();
    ++cases;
  }
  EXPECT_EQ(cases, 12U);
  EXPECT_GT(sizes, 500U);
}

TEST(GrowRegion, OfNothingOrOfOppositeNormalsIsEmpty) {
  SurfaceMesh plane = test::plane_sheet(0.2, 0.2, 0.01);
  const std::vector<std::uint32_t> two{0, 1};
  EXPECT_EQ(grow_region(plane, two, 0.0, 0.1), two);
  EXPECT_TRUE(grow_region(plane, {}, 0.05, 0.1).empty());
  plane.normals[0] = {0, 0, -1};
  EXPECT_TRUE(grow_region(plane, two, 0.1, 1.0).empty());
}

TEST(GrowRegion, RefusesASeedThatIsNotThere) {
  const std::vector<std::uint32_t> seeds{9};
  expect_error(ErrorCode::invalid_argument, "vertex 9",
               [&] { (void)grow_region(test::plane_sheet(0.1, 0.1, 0.05), seeds, 0.1, 1.0); });
}

}  // namespace
}  // namespace viewgain
