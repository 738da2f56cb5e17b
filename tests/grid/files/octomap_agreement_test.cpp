// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// OctoMap's own insertPointCloud and CloudIntegrator on the same clouds.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate_cloud.hpp"
#include "viewgain/grid/octomap_tree.hpp"

namespace viewgain {
namespace {

using namespace test;

/// The points of a view with noise along the ray, in single precision as OctoMap's are.
std::vector<std::array<double, 3>> noisy_cloud(const Sensor& sensor, int view,
                                               std::mt19937& random) {
  const Pose pose = ring_view(view);
  const DepthFrame frame = see_spheres(sensor, pose, three_spheres_in_a_room());
  const auto rays = sensor.camera.ray_table();
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto depth = static_cast<double>(frame.depth[i]);
    if (!std::isfinite(depth) || depth <= 0) continue;
    const double range = depth * rays[i].norm();
    const double noisy = range + sensor.sigmas(range).axial * normal(random);
    const Eigen::Vector3d p = pose * (rays[i].normalized() * noisy);
    const auto single = [](double v) { return static_cast<double>(static_cast<float>(v)); };
    points.push_back({single(p.x()), single(p.y()), single(p.z())});
  }
  return points;
}

/// Distance of a point from the nearest sphere's surface [m].
double to_surface(const Eigen::Vector3d& p) {
  double nearest = 1e9;
  for (const Sphere& sphere : three_spheres_in_a_room()) {
    nearest = std::min(nearest, std::abs((p - sphere.center).norm() - sphere.radius));
  }
  return nearest;
}

struct Agreement {
  std::uint64_t free = 0, free_agreed = 0;  ///< more than a voxel from any surface
  std::uint64_t occupied = 0, occupied_agreed = 0;
  std::uint64_t differences = 0, occupied_in_ours = 0;  ///< and free in theirs
  [[nodiscard]] double of_free() const {
    return static_cast<double>(free_agreed) / static_cast<double>(free);
  }
  [[nodiscard]] double of_occupied() const {
    return static_cast<double>(occupied_agreed) / static_cast<double>(occupied);
  }
};

Agreement compare(const BeliefGrid& a, const BeliefGrid& b, double voxel) {
  Agreement result;
  const Index3 low = a.min_index(), dims = a.dims();
  for (int x = low.x; x < low.x + dims.x; ++x) {
    for (int y = low.y; y < low.y + dims.y; ++y) {
      for (int z = low.z; z < low.z + dims.z; ++z) {
        const VoxelState s = a.state({x, y, z}), t = b.state({x, y, z});
        result.differences += s != t;
        result.occupied_in_ours += s == VoxelState::occupied && t == VoxelState::free;
        if (s == VoxelState::occupied || t == VoxelState::occupied) {
          ++result.occupied;
          result.occupied_agreed += s == t;
        }
        if (s != VoxelState::free && t != VoxelState::free) continue;
        if (to_surface((Eigen::Vector3d(x, y, z).array() + 0.5) * voxel) <= voxel) continue;
        ++result.free;
        result.free_agreed += s == t;
      }
    }
  }
  return result;
}

/// Our cloud, origin too, is moved by `shift` [m] along x.
Agreement agreement(const Sensor& sensor, int views, double shift = 0) {
  const double voxel = 0.02;
  const GridConfig config{voxel, {{-1.6, -1.6, -1.6}, {1.6, 1.6, 1.6}}, {}, 0.01};
  BeliefGrid ours(config);
  octomap::OcTree tree(voxel);
  std::mt19937 random(17);
  CloudIntegrator integrator(sensor);
  for (int view = 0; view < views; ++view) {
    auto points = noisy_cloud(sensor, view, random);
    octomap::Pointcloud cloud;
    for (const auto& p : points) {
      cloud.push_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
    }
    const Eigen::Vector3d from = ring_view(view).translation();
    const octomap::point3d origin(static_cast<float>(from.x()), static_cast<float>(from.y()),
                                  static_cast<float>(from.z()));
    tree.insertPointCloud(cloud, origin);
    for (auto& p : points) p[0] += shift;
    const Eigen::Vector3d rounded(shift + static_cast<double>(origin.x()),
                                  static_cast<double>(origin.y()), static_cast<double>(origin.z()));
    integrator.integrate(ours, points, Pose(Eigen::Matrix3d::Identity(), rounded));
  }
  OctomapConfig same;
  same.workspace = config.workspace;
  const Agreement result = compare(ours, grid_from_octree(tree, same), voxel);
  std::printf("%.4f %% of %llu free voxels, %.3f %% of %llu occupied ones agree\n",
              100 * result.of_free(), static_cast<unsigned long long>(result.free),
              100 * result.of_occupied(), static_cast<unsigned long long>(result.occupied));
  return result;
}

Sensor sensor_with(const NoiseModel& noise, int width, int height) {
  Sensor sensor = small_sensor(width, height);
  sensor.max_range = 5.0;
  sensor.noise = noise;
  return sensor;
}

TEST(OctomapAgreement, CloudsMakeTheSameMap) {
  const Sensor sensor = sensor_with(ConstantNoise{0.0005, 0.0005}, 160, 120);
  const Agreement sharp = agreement(sensor, 6);
  EXPECT_GT(sharp.free, 100000U);
  EXPECT_GT(sharp.occupied, 5000U);
  EXPECT_GE(sharp.of_free(), 0.9995);
  EXPECT_GE(sharp.of_occupied(), 0.999);
  // The comparison sees half a voxel.
  const Agreement spoilt = agreement(sensor, 6, 0.01);
  EXPECT_LT(spoilt.of_free(), 0.995);
  EXPECT_LT(spoilt.of_occupied(), 0.90);
}

// A crossing's weight falls over the last 3 sigma_ax before the reading, which OctoMap does not do:
// it frees voxels of noisy surfaces that keep occupied with us. A hit stands two full crossings, so
// that it takes many views of a place. The rest are voxels of the halo, whose readings go with us
// where their support is.
TEST(OctomapAgreement, TheTaperKeepsNoisySurfacesOccupied) {
  const Agreement noisy = agreement(sensor_with(sensor_preset("sr4000").noise, 80, 60), 24);
  EXPECT_GT(noisy.free, 100000U);
  EXPECT_GE(noisy.of_free(), 0.995);
  EXPECT_GE(noisy.of_occupied(), 0.90);
  EXPECT_GT(noisy.differences, 20U);
  EXPECT_GE(static_cast<double>(noisy.occupied_in_ours),
            0.8 * static_cast<double>(noisy.differences));
}

}  // namespace
}  // namespace viewgain
