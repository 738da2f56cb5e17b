// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface points out of beliefs: against a slow search over all voxels.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include "grid/voxels.hpp"
#include "noisy_plane.hpp"
#include "viewgain/grid/fused_points.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

Vector3d vector(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

// The definition of a pooled point by brute force: every cube of voxels of the map is asked for
// every seed.
struct SlowBelief {
  Vector3d center = Vector3d::Zero();  // [m], as all of these, grid frame
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Vector3d pull = Vector3d::Zero();  // Σ Λ_r p_r
  double hits = 0;
  bool occupied = false;
  Vector3d toward_free = Vector3d::Zero();

  Vector3d mean() const { return information.inverse() * pull; }
};

std::vector<SlowBelief> all_beliefs(const BeliefGrid& grid, int shift) {
  std::map<std::array<std::int32_t, 3>, SlowBelief> cubes;
  const double V = grid.voxel_size();
  test::for_each_voxel(grid, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    const auto belief = grid.belief({x, y, z});
    if (!belief) return;
    SlowBelief& cube = cubes[{x >> shift, y >> shift, z >> shift}];
    const Eigen::Matrix3d information = belief->information_matrix().matrix();
    const auto& eta = belief->information_vector;
    cube.center = (Vector3d(x >> shift, y >> shift, z >> shift).array() + 0.5) * (V * (1 << shift));
    cube.information += information;
    cube.pull += information * Vector3d((Vector3d(x, y, z).array() + 0.5) * V) +
                 Vector3d(eta[0], eta[1], eta[2]);
    cube.hits += belief->hits;
    cube.occupied = cube.occupied || grid.state({x, y, z}) == VoxelState::occupied;
  });
  std::map<std::array<std::int32_t, 3>, int>
      sides;  // 1: a voxel is free, none occupied; 0: occupied; -1
  test::for_each_voxel(grid, [&](Index3 voxel) {
    const VoxelState state = grid.state(voxel);
    int& side =
        sides.try_emplace({voxel.x >> shift, voxel.y >> shift, voxel.z >> shift}, -1).first->second;
    if (state == VoxelState::occupied) side = 0;
    if (state == VoxelState::free && side == -1) side = 1;
  });
  std::vector<SlowBelief> result;
  for (auto& [index, cube] : cubes) {
    for (int x = -3; x <= 3; ++x) {
      for (int y = -3; y <= 3; ++y) {
        for (int z = -3; z <= 3; ++z) {
          const auto found = sides.find({index[0] + x, index[1] + y, index[2] + z});
          if (found != sides.end()) cube.toward_free += found->second * Vector3d(x, y, z);
        }
      }
    }
    result.push_back(cube);
  }
  return result;
}

struct SlowPoint {
  Vector3d position;
  Eigen::Matrix3d covariance;
  double hits;
  bool of_two_faces;
  double variance;  // of one reading along the normal [m²]
  double scatter;   // variance of the column's means along it [m²]
};

SlowPoint slow_point(const std::vector<SlowBelief>& beliefs, const SlowBelief& own, double cube,
                     double length, const FusedPointsConfig& config) {
  double weight = 0;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const SlowBelief& b : beliefs) {
    const Vector3d d = b.center - own.center;
    if (d.norm() > config.normal_radius * length * (1 + 1e-12)) continue;
    Eigen::Index axis = 0;
    if (own.toward_free.cwiseAbs().maxCoeff(&axis) > 0) {
      const double along = b.toward_free[axis] * (own.toward_free[axis] < 0 ? -1 : 1);
      if (along < -0.5 * b.toward_free.norm()) continue;  // the other side
    }
    weight += b.hits;
    sum += b.hits * d;
    squares += b.hits * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      squares / weight - sum / weight * (sum / weight).transpose());
  Vector3d n = solver.eigenvectors().col(0);
  if (n.dot(own.toward_free) < 0) n = -n;
  Vector3d p = own.center + (own.mean() - own.center).cwiseMax(-0.5 * cube).cwiseMin(0.5 * cube);
  const double sigma = std::sqrt(own.hits * n.dot(own.information.inverse() * n));
  const double half_height = std::clamp(config.column_sigmas * sigma, cube, 6 * cube);
  SlowPoint point{p, Eigen::Matrix3d::Zero(), 0, false, 0, 0};
  for (int step = 0; step < 3; ++step) {
    std::array<double, 2> hits{}, height{}, square{};  // of this face, of the other
    std::array<Eigen::Matrix3d, 2> covariance{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
    for (const SlowBelief& b : beliefs) {
      const Vector3d d = b.center - point.position;
      const double h = d.dot(n);
      if (std::abs(h) > half_height || (d - h * n).norm() > config.column_radius * length) continue;
      const std::size_t face = b.toward_free.dot(n) < 0 ? 1 : 0;
      covariance[face] += b.hits * b.hits * b.information.inverse();
      height[face] += b.hits * n.dot(b.mean() - point.position);
      square[face] += b.hits * std::pow(n.dot(b.mean() - point.position), 2);
      hits[face] += b.hits;
    }
    double share = 1;
    if (hits[0] > 0 && hits[1] > 0) {
      const double apart = std::abs(height[0] / hits[0] - height[1] / hits[1]);
      const double more = (apart - sigma) / cube;
      share = more <= 0 ? 1 : more >= 0.2 ? 0 : 1 - more / 0.2;
      point.of_two_faces = share < 1;
    }
    point.hits = hits[0] + share * hits[1];
    const double mean = (height[0] + share * height[1]) / point.hits;
    point.position += mean * n;
    point.scatter = (square[0] + share * square[1]) / point.hits - mean * mean;
    point.covariance = (covariance[0] + share * share * covariance[1]) / (point.hits * point.hits);
    point.variance = std::floor(point.hits) * n.dot(point.covariance * n);
  }
  return point;
}

TEST(FusedColumns, PooledAgreesWithASearchOverAllVoxels) {
  std::size_t compared = 0, of_two_faces = 0, of_many_views = 0, of_other_floor = 0;
  struct Case {
    double V;
    int shift, behind;
  };
  // Voxels, cubes of 2³ voxels, columns that are wider than a voxel; a plate of 6 mm.
  for (const auto& [V, shift, behind] :
       {Case{0.004, 0, 0}, {0.001, 1, 0}, {0.0015, 0, 0}, {0.004, 0, 2}, {0.001, 1, 3}}) {
    const BeliefGrid grid =
        noisy_plane(V, 4, {}, IntegrationConfig::Occupancy::probabilistic, behind, 0.006);
    const Pooling pooling = pooling_of(grid.snapshot());
    ASSERT_EQ(pooling.shift, shift);
    FusedPointsConfig config;
    config.min_distance = 0;  // every seed survives
    config.min_relative_evidence = 0;
    config.min_hits = 1;
    config.floor_sigma = 0;
    const std::vector<FusedPoint> points = fused_points(grid, config);
    config.floor_sigma.reset();
    const std::vector<FusedPoint> with_floor = fused_points(grid, config);
    ASSERT_EQ(with_floor.size(), points.size());
    const double cube = V * (1 << shift);
    const double area = std::numbers::pi * std::pow(config.column_radius * pooling.length, 2);
    const std::vector<SlowBelief> beliefs = all_beliefs(grid, shift);
    std::size_t seeds = 0, of_this = 0;
    for (const SlowBelief& own : beliefs) {
      if (!own.occupied) continue;
      ++seeds;
      if (seeds % 17 != 0) continue;
      const SlowPoint expected = slow_point(beliefs, own, cube, pooling.length, config);
      const double views = std::floor(expected.hits) * kSigmaLateral * kSigmaLateral / area;
      const double F = std::min(1.0, 0.2 + 2 / std::max(views, 1.0)) *
                       (0.19 * 0.19 * expected.variance + 0.43 * 0.43 * expected.scatter +
                        0.02 * 0.02 * cube * cube);
      bool found = false, has_floor = false;
      for (std::size_t i = 0; i < points.size() && !has_floor; ++i) {
        const Eigen::Matrix3d covariance = points[i].covariance.matrix();
        if (std::abs(points[i].hits - expected.hits) > 1 ||
            (vector(points[i].position) - expected.position).norm() > 1e-8 ||
            (covariance - expected.covariance).norm() > 1e-6 * expected.covariance.norm()) {
          continue;
        }
        found = true;
        const Eigen::Matrix3d added = with_floor[i].covariance.matrix() - covariance;
        has_floor = (added - F * Eigen::Matrix3d::Identity()).norm() < 0.1 * F;
      }
      EXPECT_TRUE(found) << own.center.transpose();
      if (!has_floor) ++of_other_floor;
      ++of_this;
      if (views > 3) ++of_many_views;
      if (expected.of_two_faces) ++of_two_faces;
    }
    EXPECT_EQ(points.size(), seeds);
    EXPECT_GT(of_this, 80U);
    compared += of_this;
  }
  EXPECT_GT(compared, 400U);
  EXPECT_GT(of_two_faces, 100U);
  EXPECT_GT(of_many_views, 50U);
  EXPECT_LE(of_other_floor, 1U);  // where a voxel's centre lies on a column's border
}

}  // namespace
}  // namespace viewgain
