// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface points out of beliefs: against a slow search over all voxels, and against a plane and a
// sphere whose noise is known.

#include "viewgain/grid/fused_points.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/expect_error.hpp"
#include "core/random_values.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kPlaneZ = 0.4;  // [m] in front of the camera
constexpr double kSigmaAxial = 0.0036, kSigmaLateral = 0.0018;

Sensor plane_sensor() {
  Sensor sensor = small_sensor(64, 64);
  sensor.camera.fx = sensor.camera.fy = 220;
  sensor.camera.cx = sensor.camera.cy = 31.5;
  sensor.noise = ConstantNoise{kSigmaAxial, kSigmaLateral};
  sensor.min_range = 0.1;
  return sensor;
}

// A frontal plane as a noisy sensor sees it, `frames` times.
BeliefGrid noisy_plane(double voxel, int frames, const Pose& T_world_grid = {}) {
  const Sensor sensor = plane_sensor();
  BeliefGrid grid({voxel, {{-0.06, -0.06, 0.34}, {0.06, 0.06, 0.46}}, T_world_grid, 0.0072});
  FrameIntegrator integrator(sensor);
  RandomValues random(7);
  for (int i = 0; i < frames; ++i) {
    DepthFrame frame{64, 64, {}};
    for (const Vector3d& ray : sensor.camera.ray_table()) {
      const double range = kPlaneZ * ray.norm() + kSigmaAxial * random.normal();
      frame.depth.push_back(static_cast<float>(range / ray.norm()));
    }
    integrator.integrate(grid, frame, T_world_grid);  // the camera's frame is the grid's
  }
  return grid;
}

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
  literal.rule = PointRule::per_voxel;
  int cases = 0;
  for (const double voxel : {0.002, 0.003125, 0.006}) {
    for (const int frames : {3, 30}) {
      const BeliefGrid grid = noisy_plane(voxel, frames);
      const double pooled = plane_consistency(fused_points(grid));
      EXPECT_LT(pooled, 2.0) << voxel << " " << frames;
      if (frames == 30) {
        EXPECT_GT(plane_consistency(fused_points(grid, literal)), 3.0) << voxel;
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 6);
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
    EXPECT_LT(std::abs(point.position[2] - kPlaneZ), 3e-3);
    EXPECT_NEAR(vector(point.toward_free).norm(), 1.0, 1e-12);
    if (point.toward_free[2] < -0.95) ++normals;
    ++checked;
  }
  ASSERT_GT(checked, 600U);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(checked)), 0.25 * kSigmaAxial);
  EXPECT_GT(static_cast<double>(normals), 0.98 * static_cast<double>(checked));
  // One point a place: about as many as voxels on the plane, none nearer than the limit.
  EXPECT_LT(static_cast<double>(checked), 1.6 * std::pow(0.08 / 0.003125, 2));
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j, ++pairs) {
      const double d = (vector(points[i].position) - vector(points[j].position)).norm();
      ASSERT_GE(d, config.min_distance * grid.voxel_size() * (1 - 1e-9));
    }
  }
  EXPECT_GT(pairs, 100'000U);
}

TEST(FusedPoints, PerVoxelIsTheFusedPositionOfEachOccupiedVoxel) {
  const BeliefGrid grid = noisy_plane(0.003125, 3);
  FusedPointsConfig config;
  config.rule = PointRule::per_voxel;
  config.min_hits = 2;
  const std::vector<FusedPoint> points = fused_points(grid, config);
  std::vector<Vector3d> expected;
  const Index3 low = grid.min_index(), dims = grid.dims();
  for (std::int32_t x = low.x; x < low.x + dims.x; ++x) {
    for (std::int32_t y = low.y; y < low.y + dims.y; ++y) {
      for (std::int32_t z = low.z; z < low.z + dims.z; ++z) {
        const auto belief = grid.belief({x, y, z});
        if (!belief || belief->hits < 2 || grid.state({x, y, z}) != VoxelState::occupied) continue;
        const auto& eta = belief->information_vector;
        const Vector3d center = (Vector3d(x, y, z).array() + 0.5) * grid.voxel_size();
        expected.push_back(center + belief->information_matrix().inverse() *
                                        Vector3d(eta[0], eta[1], eta[2]));
      }
    }
  }
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

// The same definition by brute force: every voxel of the map is asked for every seed.
struct SlowBelief {
  Vector3d center;  // [voxels]
  Belief belief;
  bool occupied;
};

std::vector<SlowBelief> all_beliefs(const BeliefGrid& grid) {
  std::vector<SlowBelief> result;
  const Index3 low = grid.min_index(), dims = grid.dims();
  for (std::int32_t x = low.x; x < low.x + dims.x; ++x) {
    for (std::int32_t y = low.y; y < low.y + dims.y; ++y) {
      for (std::int32_t z = low.z; z < low.z + dims.z; ++z) {
        const auto belief = grid.belief({x, y, z});
        if (belief) {
          result.push_back({Vector3d(x, y, z).array() + 0.5, *belief,
                            grid.state({x, y, z}) == VoxelState::occupied});
        }
      }
    }
  }
  return result;
}

Vector3d slow_position(const std::vector<SlowBelief>& beliefs, const SlowBelief& own, double V,
                       const FusedPointsConfig& config, std::uint32_t& hits) {
  double weight = 0;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const SlowBelief& b : beliefs) {
    const Vector3d d = b.center - own.center;
    if (d.squaredNorm() > config.normal_radius * config.normal_radius) continue;
    weight += b.belief.hits;
    sum += b.belief.hits * d;
    squares += b.belief.hits * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      squares / weight - sum / weight * (sum / weight).transpose());
  const Vector3d n = solver.eigenvectors().col(0);
  const auto eta = [](const Belief& b) {
    return Vector3d(b.information_vector[0], b.information_vector[1], b.information_vector[2]);
  };
  const Eigen::Matrix3d own_covariance = own.belief.information_matrix().matrix().inverse();
  Vector3d p = own.center + own_covariance * eta(own.belief) / V;
  const double sigma = std::sqrt(own.belief.hits * n.dot(own_covariance * n)) / V;
  const double half_height = std::clamp(config.column_sigmas * sigma, 1.0, 4.0);
  for (int step = 0; step < 3; ++step) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Vector3d pull = Vector3d::Zero();
    hits = 0;
    for (const SlowBelief& b : beliefs) {
      const Vector3d d = b.center - p;
      const double h = d.dot(n);
      if (std::abs(h) > half_height || (d - h * n).norm() > config.column_radius) continue;
      information += b.belief.information_matrix().matrix();
      pull += b.belief.information_matrix().matrix() * d + eta(b.belief) / V;
      hits += b.belief.hits;
    }
    p += n.dot(information.inverse() * pull) * n;
  }
  return p * V;
}

TEST(FusedPoints, PooledAgreesWithASearchOverAllVoxels) {
  const double V = 0.004;
  const BeliefGrid grid = noisy_plane(V, 4);
  FusedPointsConfig config;
  config.min_distance = 0;  // every seed survives
  config.min_relative_hits = 0;
  config.min_hits = 1;
  std::vector<FusedPoint> points = fused_points(grid, config);
  const std::vector<SlowBelief> beliefs = all_beliefs(grid);
  std::size_t seeds = 0, compared = 0;
  for (const SlowBelief& own : beliefs) {
    if (!own.occupied) continue;
    ++seeds;
    if (seeds % 7 != 0) continue;
    std::uint32_t hits = 0;
    const Vector3d expected = slow_position(beliefs, own, V, config, hits);
    const bool found = std::any_of(points.begin(), points.end(), [&](const FusedPoint& point) {
      return point.hits == hits && (vector(point.position) - expected).norm() < 1e-8;
    });
    EXPECT_TRUE(found) << own.center.transpose();
    ++compared;
  }
  EXPECT_EQ(points.size(), seeds);
  EXPECT_GT(compared, 150U);
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
      EXPECT_NEAR(n.dot(vector(other.toward_free)), 1.0, 1e-6);
      ++same;
      break;
    }
  }
  EXPECT_GT(static_cast<double>(same), 0.95 * static_cast<double>(a.size()));
}

TEST(FusedPoints, SameForAnyNumberOfThreads) {
  const BeliefGrid grid = noisy_plane(0.003125, 3);
  const auto one = fused_points(grid, {}, {1});
  ASSERT_GT(one.size(), 800U);
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

TEST(FusedPoints, HaloBesideAWellSeenSurfaceIsLeftOut) {
  // A well seen plate of 12 x 12 voxels and, 3 voxels beyond its rim, a row that few readings hit.
  BeliefGrid grid({0.01, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
  const auto put = [&](std::int32_t x, std::int32_t y, std::uint32_t hits) {
    const float information = 1e5F * static_cast<float>(hits);
    grid.set({x, y, 0}, 2.0F,
             Belief{{information, information, information, 0, 0, 0}, {0, 0, 0}, hits});
  };
  for (std::int32_t x = -6; x < 6; ++x) {
    for (std::int32_t y = -6; y < 6; ++y) put(x, y, 20);
    put(x, 8, 3);
  }
  const auto halo = [](const std::vector<FusedPoint>& points) {
    return std::count_if(points.begin(), points.end(),
                         [](const FusedPoint& p) { return p.position[1] > 0.075; });
  };
  FusedPointsConfig all;
  all.min_relative_hits = 0;
  EXPECT_EQ(fused_points(grid, all).size(), 156U);
  EXPECT_EQ(halo(fused_points(grid, all)), 12);
  EXPECT_EQ(fused_points(grid).size(), 144U);
  EXPECT_EQ(halo(fused_points(grid)), 0);
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
  refuses("min_relative_hits", [](auto& c) { c.min_relative_hits = 1.5; });
  refuses("min_distance", [](auto& c) { c.min_distance = -0.1; });
  refuses("floor_sigma", [](auto& c) { c.floor_sigma = INFINITY; });
}

}  // namespace
}  // namespace viewgain
