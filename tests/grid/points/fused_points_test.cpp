// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface points out of beliefs, against a plane and a sphere whose noise is known.

#include "viewgain/grid/fused_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "core/random_values.hpp"
#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "noisy_plane.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

Vector3d vector(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

// Away from the plane's rim, where columns are cut.
bool inner(const FusedPoint& point) {
  return std::abs(point.position[0]) < 0.04 && std::abs(point.position[1]) < 0.04;
}

// Mean of min(z², 25) with e along the plane's normal.
double plane_consistency(const std::vector<FusedPoint>& points) {
  double sum = 0;
  std::size_t count = 0;
  for (const FusedPoint& point : points) {
    if (!inner(point)) continue;
    const double e = point.position[2] - kPlaneZ;
    sum += std::min(e * e / point.covariance.zz, 25.0);
    ++count;
  }
  EXPECT_GT(count, 150U);
  return sum / static_cast<double>(count);
}

TEST(FusedPoints, PooledStaysHonestAsReadingsAccumulateLiteralDoesNot) {
  FusedPointsConfig literal;
  literal.per_voxel = true;
  for (const double voxel : {0.002, 0.003125, 0.006}) {
    for (const int frames : {3, 30}) {
      const BeliefGrid grid = noisy_plane(voxel, frames);
      const double pooled = plane_consistency(fused_points(grid));
      EXPECT_LT(pooled, 2.0) << voxel << " " << frames;
      if (frames == 30) {
        const BeliefGrid of_paper =
            noisy_plane(voxel, frames, {}, IntegrationConfig::Occupancy::literal);
        EXPECT_GT(plane_consistency(fused_points(of_paper, literal)), 2.0) << voxel;
      }
    }
  }
}

TEST(FusedPoints, PooledPointsLieOnThePlaneOncePerPlaceAndPointAtTheCamera) {
  const BeliefGrid grid = noisy_plane(0.003125, 10);
  const FusedPointsConfig config;
  const std::vector<FusedPoint> points = fused_points(grid, config);
  std::size_t checked = 0, normals = 0;
  double squares = 0;
  for (const FusedPoint& point : points) {
    if (!inner(point)) continue;
    squares += std::pow(point.position[2] - kPlaneZ, 2);
    EXPECT_LT(std::abs(point.position[2] - kPlaneZ), 4e-3);
    EXPECT_NEAR(vector(point.toward_free).norm(), 1.0, 1e-12);
    if (point.toward_free[2] < -0.95) ++normals;
    ++checked;
  }
  ASSERT_GT(checked, 600U);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(checked)), 0.3 * kSigmaAxial);
  EXPECT_GT(static_cast<double>(normals), 0.98 * static_cast<double>(checked));
  // One point a place: about as many as voxels on the plane, few nearer than the limit, and those
  // where there would be a hole.
  EXPECT_LT(static_cast<double>(checked), 1.6 * std::pow(0.08 / 0.003125, 2));
  std::size_t pairs = 0, nearer = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j, ++pairs) {
      const double d = (vector(points[i].position) - vector(points[j].position)).norm();
      ASSERT_GE(d, 0.4 * grid.voxel_size() * (1 - 1e-9));
      if (d < config.min_distance * grid.voxel_size()) ++nearer;
    }
  }
  EXPECT_LT(nearer, points.size() / 4);
  EXPECT_GT(pairs, 100'000U);
}

// What readings share is added once, along the mean way from the views that see the free side.
TEST(FusedPoints, AScaleErrorIsSharedByAllReadings) {
  const Eigen::Matrix3d back = Vector3d(1, -1, -1).asDiagonal();  // looks along -z
  const Pose placed({back}, {0.3, -0.2, 0.7});
  BeliefGrid grid = noisy_plane(0.003125, 10, placed);
  FrameIntegrator integrator(plane_sensor());
  const DepthFrame nothing{64, 64, std::vector<float>(64 * 64, DepthFrame::kInvalid)};
  const Vector3d beside(0.15, 0, 0.1);
  integrator.integrate(grid, nothing, placed * Pose(Eigen::Matrix3d::Identity(), beside));
  // Behind the plane, and before it but looking away: they count for nothing.
  integrator.integrate(grid, nothing, placed * Pose(back, Vector3d(0, 0, 0.8)));
  integrator.integrate(grid, nothing, placed * Pose(back, Vector3d(0, 0, 0.1)));
  constexpr double kScaleSigma = 0.02;
  const std::vector<FusedPoint> own = fused_points(grid);
  const std::vector<FusedPoint> all = fused_points(grid, {.scale_sigma = kScaleSigma});
  ASSERT_EQ(own.size(), all.size());
  std::size_t checked = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Vector3d p = placed.inverse() * vector(own[i].position);
    const Vector3d n = placed.rotation().transpose() * vector(own[i].toward_free);
    const auto readings = [&](const Vector3d& way) {
      return -n.dot(way.normalized()) / way.squaredNorm();
    };
    if (!inner({{p.x(), p.y(), p.z()}}) || n.z() > -0.95) continue;
    const double often = 10 * readings(p), seldom = readings(p - beside);
    const Vector3d mean = (often * p + seldom * (p - beside)) / (often + seldom);
    const Vector3d moves = kScaleSigma * (placed.rotation() * mean);
    const Eigen::Matrix3d added = all[i].covariance.matrix() - own[i].covariance.matrix();
    EXPECT_LT((added - moves * moves.transpose()).norm(), 1e-9 * added.norm());
    EXPECT_EQ(all[i].position, own[i].position);
    ++checked;
  }
  EXPECT_GT(checked, 300U);
  expect_error(ErrorCode::invalid_argument, "scale_sigma",
               [&] { (void)fused_points(grid, {.scale_sigma = -0.1}); });
}

TEST(FusedPoints, WhereCutsOutAPartAndFarFromItsBorderChangesNothing) {
  const BeliefGrid grid = noisy_plane(0.003125, 10);
  const std::vector<FusedPoint> all = fused_points(grid);
  FusedPointsConfig half;
  half.where = [](const Vector3d& p) { return p.x() < 0; };
  const std::vector<FusedPoint> part = fused_points(grid, half, {2});
  const auto deep = [&](const std::vector<FusedPoint>& points) {
    std::vector<std::array<double, 3>> positions;
    for (const FusedPoint& p : points) {
      if (p.position[0] < -10 * grid.voxel_size()) positions.push_back(p.position);
    }
    return positions;
  };
  for (const FusedPoint& p : part) EXPECT_LT(p.position[0], 10 * grid.voxel_size());
  EXPECT_GT(deep(part).size(), 100U);
  EXPECT_EQ(deep(part), deep(all));
  half.where = [](const Vector3d&) { return false; };
  EXPECT_TRUE(fused_points(grid, half).empty());
}

TEST(FusedPoints, PerVoxelIsTheFusedPositionOfEachOccupiedVoxel) {
  const BeliefGrid grid = noisy_plane(0.003125, 3);
  FusedPointsConfig config;
  config.per_voxel = true;
  config.min_hits = 2;
  const std::vector<FusedPoint> points = fused_points(grid, config);
  std::vector<Vector3d> expected;
  test::for_each_voxel(grid, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    const auto belief = grid.belief({x, y, z});
    if (!belief || belief->hits < 2 || grid.state({x, y, z}) != VoxelState::occupied) return;
    const auto& eta = belief->information_vector;
    const Vector3d center = (Vector3d(x, y, z).array() + 0.5) * grid.voxel_size();
    expected.push_back(center +
                       belief->information_matrix().inverse() * Vector3d(eta[0], eta[1], eta[2]));
  });
  ASSERT_EQ(points.size(), expected.size());
  ASSERT_GT(points.size(), 1000U);
  const double floor = grid.voxel_size() * grid.voxel_size() / 12;
  for (const FusedPoint& point : points) {
    const auto near = std::find_if(expected.begin(), expected.end(), [&](const Vector3d& p) {
      return (p - vector(point.position)).norm() < 1e-9;
    });
    ASSERT_NE(near, expected.end());
    EXPECT_GT(point.covariance.xx, floor);
  }
}

TEST(FusedPoints, TurnsWithTheGrid) {
  RandomValues random(3);
  const Pose T_world_grid(random.rotation(), Vector3d(0.3, -0.2, 0.1));
  const BeliefGrid straight = noisy_plane(0.003125, 5);
  const BeliefGrid turned_grid = noisy_plane(0.003125, 5, T_world_grid);
  const auto a = fused_points(straight), b = fused_points(turned_grid);
  // The camera's rotation rounds differently: a few readings change their voxel.
  ASSERT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()),
              0.02 * static_cast<double>(a.size()));
  std::size_t same = 0;
  for (const FusedPoint& point : a) {
    const Vector3d expected = T_world_grid * vector(point.position);
    for (const FusedPoint& other : b) {
      if ((vector(other.position) - expected).norm() > 1e-6) continue;
      const SymmetricMatrix3 covariance = turned(point.covariance, T_world_grid.rotation());
      EXPECT_NEAR(other.covariance.xx, covariance.xx, 1e-3 * covariance.xx);
      EXPECT_NEAR(other.covariance.yz, covariance.yz, 1e-3 * covariance.xx);
      const Vector3d n = T_world_grid.rotation() * vector(point.toward_free);
      EXPECT_NEAR(n.dot(vector(other.toward_free)), 1.0, 1e-5);
      ++same;
      break;
    }
  }
  EXPECT_GT(static_cast<double>(same), 0.95 * static_cast<double>(a.size()));
}

TEST(FusedPoints, SameForAnyNumberOfThreads) {
  for (const int behind : {0, 2}) {  // a plane, both faces of a plate
    const BeliefGrid grid =
        noisy_plane(0.003125, 3, {}, IntegrationConfig::Occupancy::probabilistic, behind, 0.006);
    const auto one = fused_points(grid, {}, {1});
    ASSERT_GT(one.size(), behind == 0 ? 800U : 1600U);
    for (const int threads : {2, 3, 8}) {
      const auto many = fused_points(grid, {}, {threads});
      ASSERT_EQ(many.size(), one.size());
      for (std::size_t i = 0; i < one.size(); ++i) {
        ASSERT_EQ(many[i].position, one[i].position);
        ASSERT_EQ(many[i].covariance, one[i].covariance);
        ASSERT_EQ(many[i].toward_free, one[i].toward_free);
      }
    }
  }
}

TEST(FusedPoints, NothingWhereThereIsNoEvidence) {
  const GridConfig config{0.01, {{-0.04, -0.04, -0.04}, {0.04, 0.04, 0.04}}, {}, 0.01};
  EXPECT_TRUE(fused_points(BeliefGrid(config)).empty());
  const std::vector<std::uint8_t> occupied(512, 2);  // states without a reading
  EXPECT_TRUE(fused_points(BeliefGrid::from_states(config, occupied)).empty());
  // A single reading: too little support by default, a point if asked for.
  BeliefGrid grid(config);
  grid.set({0, 0, 0}, 0.85F, Belief{{1e5F, 1e5F, 1e4F, 0, 0, 0}, {0, 0, 20.0F}, 1});
  EXPECT_TRUE(fused_points(grid).empty());
  FusedPointsConfig lenient;
  lenient.min_hits = 1;
  const auto points = fused_points(grid, lenient);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_TRUE(vector(points[0].position).allFinite());
}

TEST(FusedPoints, RefusesSettingsOutOfBounds) {
  const BeliefGrid grid({0.01, {{0, 0, 0}, {0.1, 0.1, 0.1}}, {}, 0.01});
  const auto refuses = [&](const char* name, auto&& change) {
    FusedPointsConfig config;
    change(config);
    expect_error(ErrorCode::invalid_argument, name, [&] { (void)fused_points(grid, config); });
  };
  refuses("normal_radius", [](auto& c) { c.normal_radius = 8.5; });
  refuses("normal_radius", [](auto& c) { c.normal_radius = std::nan(""); });
  refuses("column_radius", [](auto& c) { c.column_radius = 0; });
  refuses("column_sigmas", [](auto& c) { c.column_sigmas = -1; });
  refuses("min_relative_evidence", [](auto& c) { c.min_relative_evidence = 1.5; });
  refuses("min_distance", [](auto& c) { c.min_distance = -0.1; });
  refuses("floor_sigma", [](auto& c) { c.floor_sigma = INFINITY; });
}

}  // namespace
}  // namespace viewgain
