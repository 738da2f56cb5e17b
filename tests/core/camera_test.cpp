// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/camera.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include "expect_error.hpp"
#include "random_values.hpp"
#include "viewgain/support/shared_rays.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::RandomValues;

PinholeCamera small_camera(const std::array<double, 5>& distortion = {}) {
  return {.width = 64,
          .height = 48,
          .fx = 50,
          .fy = 52,
          .cx = 31.2,
          .cy = 23.9,
          .distortion = distortion};
}

/// OpenCV's published formula, term by term, in long double.
Eigen::Vector2d opencv_project(const PinholeCamera& camera, const Eigen::Vector3d& p) {
  const long double x = static_cast<long double>(p.x()) / p.z();
  const long double y = static_cast<long double>(p.y()) / p.z();
  const long double k1 = camera.distortion[0], k2 = camera.distortion[1];
  const long double p1 = camera.distortion[2], p2 = camera.distortion[3];
  const long double k3 = camera.distortion[4];
  const long double r = std::sqrt(x * x + y * y);
  const long double radial = 1 + k1 * std::pow(r, 2) + k2 * std::pow(r, 4) + k3 * std::pow(r, 6);
  const long double xd = x * radial + 2 * p1 * x * y + p2 * (r * r + 2 * x * x);
  const long double yd = y * radial + p1 * (r * r + 2 * y * y) + 2 * p2 * x * y;
  return {static_cast<double>(camera.fx * xd + camera.cx),
          static_cast<double>(camera.fy * yd + camera.cy)};
}

/// Whether the model keeps orientation, by central differences, everywhere within `radius`.
bool unfolded(const PinholeCamera& camera, double radius) {
  constexpr double kStep = 1e-5;
  for (int i = 0; i <= 40; ++i) {
    for (int k = 0; k < 16; ++k) {
      const double r = radius * i / 40.0, angle = k * 3.14159265358979323846 / 8.0;
      const double x = r * std::cos(angle), y = r * std::sin(angle);
      const Eigen::Vector2d dx =
          opencv_project(camera, {x + kStep, y, 1}) - opencv_project(camera, {x - kStep, y, 1});
      const Eigen::Vector2d dy =
          opencv_project(camera, {x, y + kStep, 1}) - opencv_project(camera, {x, y - kStep, 1});
      const double determinant = dx.x() * dy.y() - dx.y() * dy.x();
      // Relative to the undistorted 4 fx fy step²: well away from a fold.
      if (determinant < 0.05 * 4 * camera.fx * camera.fy * kStep * kStep) return false;
    }
  }
  return true;
}

TEST(PinholeCamera, WithoutDistortionIsTheTextbookFormula) {
  const PinholeCamera camera = small_camera();
  EXPECT_FALSE(camera.has_distortion());
  EXPECT_EQ(camera.ray(camera.cx, camera.cy), Eigen::Vector3d(0, 0, 1));
  EXPECT_LT((camera.ray(56.2, -2.1) - Eigen::Vector3d(0.5, -0.5, 1)).norm(), 1e-15);
  const Eigen::Vector2d pixel = camera.project({0.2, -0.4, 2});
  EXPECT_NEAR(pixel.x(), 36.2, 1e-13);
  EXPECT_NEAR(pixel.y(), 13.5, 1e-13);
}

TEST(PinholeCamera, ProjectsAsOpenCvPublished) {
  RandomValues random(1);
  for (int i = 0; i < 5000; ++i) {
    const PinholeCamera camera =
        small_camera({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.1, 0.1),
                      random.uniform(-0.1, 0.1), random.uniform(-1, 1)});
    const double z = random.magnitude(0.01, 100);
    const Eigen::Vector3d p(z * random.uniform(-1, 1), z * random.uniform(-1, 1), z);
    ASSERT_LT((camera.project(p) - opencv_project(camera, p)).norm(), 1e-11);
  }
}

TEST(PinholeCamera, RayUndoesStrongDistortions) {
  RandomValues random(2);
  int cameras = 0, rays = 0, tries = 0;
  while (cameras < 300 && ++tries < 20'000) {
    const PinholeCamera camera =
        small_camera({random.uniform(-0.5, 1), random.uniform(-0.5, 1), random.uniform(-0.05, 0.05),
                      random.uniform(-0.05, 0.05), random.uniform(-0.5, 1)});
    if (!unfolded(camera, 0.8)) continue;
    ++cameras;
    for (int i = 0; i < 50; ++i, ++rays) {
      const double r = 0.75 * std::sqrt(random.uniform(0, 1)), angle = random.uniform(0, 6.2831853);
      const Eigen::Vector3d direction(r * std::cos(angle), r * std::sin(angle), 1);
      const Eigen::Vector2d pixel = opencv_project(camera, direction);
      const Eigen::Vector3d ray = camera.ray(pixel.x(), pixel.y());
      ASSERT_LT((ray - direction).norm(), 1e-11) << "camera " << cameras;
      ASSERT_LT((camera.project(ray) - pixel).norm(), 1e-10);
    }
  }
  EXPECT_EQ(cameras, 300);
  EXPECT_EQ(rays, 15'000);
}

TEST(PinholeCamera, APixelWithoutASolutionIsNan) {
  // r (1 - r²/2) is largest at r = sqrt(2/3), where it is 0.5443.
  const PinholeCamera camera = small_camera({-0.5, 0, 0, 0, 0});
  const auto ray_at = [&](double distorted) {
    return camera.ray(camera.cx + camera.fx * distorted, camera.cy);
  };
  EXPECT_TRUE(std::isnan(ray_at(0.56).x()));
  EXPECT_TRUE(std::isnan(ray_at(0.56).y()));
  EXPECT_TRUE(std::isnan(ray_at(-3).x()));
  const Eigen::Vector3d last = ray_at(0.54);
  EXPECT_LT(last.x(), std::sqrt(2.0 / 3.0));
  EXPECT_NEAR(last.x() * (1 - last.x() * last.x() / 2), 0.54, 1e-12);
}

TEST(PinholeCamera, TakesTheBranchOfTheOpticalAxis) {
  // r (1 - 0.6 r² + 0.12 r⁴) turns at r = 0.863 (0.5347) and rises again from 1.495: 0.5 has three
  // solutions or one, the nearest to the axis is meant.
  const PinholeCamera camera = small_camera({-0.6, 0.12, 0, 0, 0});
  for (int i = 1; i <= 100; ++i) {
    const double r = 0.0085 * i;
    const double distorted = r * (1 - 0.6 * r * r + 0.12 * r * r * r * r);
    const Eigen::Vector3d ray = camera.ray(camera.cx, camera.cy - camera.fy * distorted);
    ASSERT_NEAR(ray.y(), -r, 1e-8) << i;
  }
}

TEST(PinholeCamera, FollowsTheBranchUpToTheFold) {
  // r (1 + r² - r⁴/2) turns at r = 1.213, where it is 1.69: Newton's first step from the axis would
  // land beyond the fold.
  const PinholeCamera camera = small_camera({1, -0.5, 0, 0, 0});
  for (int i = 1; i <= 120; ++i) {
    const double r = 0.01 * i;
    const double distorted = r * (1 + r * r - 0.5 * r * r * r * r);
    const Eigen::Vector3d ray = camera.ray(camera.cx - camera.fx * distorted, camera.cy);
    ASSERT_NEAR(ray.x(), -r, 1e-8) << i;
  }
}

TEST(PinholeCamera, SeesWhatIsInFrontAndWithinTheOuterEdgesOfThePixels) {
  const PinholeCamera camera = {
      .width = 64, .height = 48, .fx = 64, .fy = 64, .cx = 31.5, .cy = 23.5, .distortion = {}};
  const auto at = [&](double u, double v) {
    return Eigen::Vector3d(2 * (u - camera.cx) / camera.fx, 2 * (v - camera.cy) / camera.fy, 2);
  };
  EXPECT_TRUE(camera.sees(at(-0.5, -0.5)));
  EXPECT_TRUE(camera.sees(at(63.4375, 47.4375)));
  EXPECT_FALSE(camera.sees(at(63.5, 20)));
  EXPECT_FALSE(camera.sees(at(20, 47.5)));
  EXPECT_FALSE(camera.sees(at(-0.5625, 20)));
  EXPECT_FALSE(camera.sees(at(20, -0.5625)));
  EXPECT_FALSE(camera.sees({0, 0, 0}));
  EXPECT_FALSE(camera.sees({0, 0, -1}));
  EXPECT_FALSE(camera.sees({std::numeric_limits<double>::quiet_NaN(), 0, 1}));
}

TEST(PinholeCamera, DoesNotSeeWhatTheLensFoldsIntoTheImage) {
  // r (1 - 0.6 r²) turns at r = 0.745 and is 0 again at 1.291.
  const PinholeCamera camera = small_camera({-0.6, 0, 0, 0, 0});
  int seen = 0, folded = 0;
  for (int i = 0; i <= 150; ++i) {
    const double r = 0.01 * i;
    const Eigen::Vector2d pixel = camera.project({0, r, 1});
    if (!(pixel.y() >= -0.5 && pixel.y() < camera.height - 0.5)) continue;
    EXPECT_EQ(camera.sees(Eigen::Vector3d(0, r, 1) * 3), r < 0.74) << r;
    ++(r < 0.74 ? seen : folded);
  }
  EXPECT_GT(seen, 40);
  EXPECT_GT(folded, 20);
}

TEST(PinholeCamera, ProjectBehindTheCameraIsNan) {
  EXPECT_TRUE(std::isnan(small_camera().project({1, 1, 0}).x()));
  EXPECT_TRUE(std::isnan(small_camera().project({1, 1, -1}).y()));
}

TEST(PinholeCamera, TableIsRowByRow) {
  const PinholeCamera camera = small_camera({-0.1, 0.02, 0.001, -0.001, 0});
  const auto table = camera.ray_table();
  ASSERT_EQ(table.size(), 64U * 48U);
  EXPECT_EQ(table[0], camera.ray(0, 0));
  EXPECT_EQ(table[1], camera.ray(1, 0));
  EXPECT_EQ(table[64], camera.ray(0, 1));
  EXPECT_EQ(table.back(), camera.ray(63, 47));
}

TEST(PinholeCamera, EqualCamerasShareOneTable) {
  const PinholeCamera camera = small_camera({-0.1, 0.02, 0.001, -0.001, 0});
  PinholeCamera other = camera;
  auto table = shared_rays(camera);
  EXPECT_EQ(*table, camera.ray_table());
  EXPECT_EQ(shared_rays(other).get(), table.get());
  other.cx += 1;
  const auto of_other = shared_rays(other);
  EXPECT_NE(of_other.get(), table.get());
  EXPECT_EQ(*of_other, other.ray_table());

  const std::weak_ptr<const std::vector<Eigen::Vector3d>> watched = table;
  table.reset();
  EXPECT_TRUE(watched.expired());
  EXPECT_EQ(*shared_rays(camera), camera.ray_table());
}

TEST(PinholeCamera, SharedTablesFromManyThreads) {
  std::atomic<int> equal = 0;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&equal, t] {
      for (int k = 0; k < 50; ++k) {
        const PinholeCamera camera = small_camera({0.001 * ((t + k) % 3), 0, 0, 0, 0});
        equal += *shared_rays(camera) == camera.ray_table() ? 1 : 0;
      }
    });
  }
  threads.clear();  // joins them
  EXPECT_EQ(equal, 200);
}

TEST(PinholeCamera, SolidAnglesKnowTheLens) {
  const PinholeCamera camera = small_camera({-0.2, 0.05, 0.003, -0.002, 0});
  const auto table = camera.ray_table();
  const std::vector<double> angles = camera.solid_angles(table);
  int cases = 0;
  for (int v = 2; v < 46; v += 7) {
    for (int u = 2; u < 62; u += 9, ++cases) {
      // The quadrilateral of the pixel's corners on the unit sphere.
      const auto at = [&](double du, double dv) { return camera.ray(u + du, v + dv).normalized(); };
      const Eigen::Vector3d a = at(-0.5, -0.5), b = at(0.5, -0.5), c = at(0.5, 0.5),
                            d = at(-0.5, 0.5);
      const double area = 0.5 * (c - a).cross(d - b).norm();
      const auto i = static_cast<std::size_t>(v * 64 + u);
      EXPECT_NEAR(angles[i], area, 1e-3 * area) << u << ' ' << v;
    }
  }
  EXPECT_EQ(cases, 49);
}

TEST(PinholeCamera, SolidAnglesWhereThereIsNoRay) {
  // Corners beyond the fold have no ray; their neighbours take one-sided differences.
  const PinholeCamera camera = small_camera({-0.9, 0, 0, 0, 0});
  const auto table = camera.ray_table();
  const std::vector<double> angles = camera.solid_angles(table);
  std::size_t without = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    EXPECT_EQ(angles[i] > 0, table[i].allFinite()) << i;
    EXPECT_TRUE(std::isfinite(angles[i]));
    if (!table[i].allFinite()) ++without;
  }
  EXPECT_GT(without, 50U);
  PinholeCamera pixel = small_camera();
  pixel.width = pixel.height = 1, pixel.cx = pixel.cy = 0;
  EXPECT_EQ(pixel.solid_angles(pixel.ray_table()), std::vector<double>{1.0 / 50 * (1.0 / 52)});
  expect_error(ErrorCode::invalid_argument, "rays: 3072", [&] { (void)pixel.solid_angles(table); });
}

TEST(PinholeCamera, ValidateNamesTheField) {
  const auto expect_bad = [](const char* field, const auto& spoil) {
    PinholeCamera camera = small_camera();
    spoil(camera);
    expect_error(ErrorCode::invalid_argument, field, [&] { camera.validate(); });
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(small_camera().validate());
  expect_bad("width", [](PinholeCamera& c) { c.width = 0; });
  expect_bad("width", [](PinholeCamera& c) { c.width = 16385; });
  expect_bad("height", [](PinholeCamera& c) { c.height = -3; });
  // A table of rays for the largest sides would take 6.4 GB.
  expect_bad("16384 x 16384; the maximum is 2^24 pixels",
             [](PinholeCamera& c) { c.width = c.height = 16384; });
  expect_bad("2^24 pixels", [](PinholeCamera& c) { c.width = 4096, c.height = 4097; });
  PinholeCamera largest = small_camera();
  largest.width = largest.height = 4096;
  EXPECT_NO_THROW(largest.validate());
  expect_bad("fx", [](PinholeCamera& c) { c.fx = 0; });
  expect_bad("fy", [](PinholeCamera& c) { c.fy = kNan; });
  expect_bad("cx", [](PinholeCamera& c) { c.cx = kNan; });
  expect_bad("cy", [](PinholeCamera& c) { c.cy = std::numeric_limits<double>::infinity(); });
  expect_bad("k3", [](PinholeCamera& c) { c.distortion[4] = kNan; });
  expect_bad("p1", [](PinholeCamera& c) { c.distortion[2] = kNan; });
}

}  // namespace
}  // namespace viewgain
