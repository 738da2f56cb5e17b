// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oracle/rays.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace viewgain::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Line parameter at which p + t d enters or, from inside, leaves the box.
double box_range(const Box& box, const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
  double begin = -kInfinity;
  double end = kInfinity;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (d[i] == 0) {
      if (p[i] < box.min[k] || p[i] > box.max[k]) return kInfinity;
      continue;
    }
    const double a = (box.min[k] - p[i]) / d[i];
    const double b = (box.max[k] - p[i]) / d[i];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (begin > end || end < 0) return kInfinity;
  return begin >= 0 ? begin : end;
}

/// By solving for the barycentric coordinates.
double triangle_range(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
  Eigen::Matrix3d m;
  m.col(0) = b - a;
  m.col(1) = c - a;
  m.col(2) = -d;
  if (m.determinant() == 0) return kInfinity;
  const Eigen::Vector3d uvt = m.inverse() * (p - a);
  const bool inside = uvt[0] >= 0 && uvt[1] >= 0 && uvt[0] + uvt[1] <= 1 && uvt[2] >= 0;
  return inside ? uvt[2] : kInfinity;
}

}  // namespace

std::vector<Ray> view_rays(const Pose& T_world_grid, double voxel_size, const PinholeCamera& camera,
                           int stride, const Pose& T_world_camera) {
  const std::vector<Eigen::Vector3d> table = camera.ray_table();
  const Eigen::Matrix3d R_grid_world = T_world_grid.rotation().transpose();
  const Eigen::Vector3d origin =
      R_grid_world * (T_world_camera.translation() - T_world_grid.translation()) / voxel_size;
  std::vector<Ray> rays;
  for (int v = 0; v < camera.height; v += stride) {
    for (int u = 0; u < camera.width; u += stride) {
      const Eigen::Vector3d d_camera = table[static_cast<std::size_t>(v * camera.width + u)];
      const Eigen::Vector3d d_grid =
          R_grid_world * (T_world_camera.rotation() * d_camera.normalized());
      rays.push_back({origin, d_grid.normalized()});
    }
  }
  return rays;
}

RayLimits limits_of(const DenseMap& map, const Sensor& sensor, const GainConfig& config) {
  return {config.min_range.value_or(sensor.min_range) / map.voxel_size,
          config.max_range.value_or(sensor.max_range) / map.voxel_size, kInfinity};
}

double obstacle_range(const DenseMap& map, const Obstacles& obstacles, const Ray& ray) {
  const Eigen::Matrix3d R_world_grid = map.T_world_grid.rotation();
  const Eigen::Vector3d p = map.T_world_grid * (map.voxel_size * ray.origin);
  const Eigen::Vector3d d = map.voxel_size * (R_world_grid * ray.direction);  // t stays in voxels
  double nearest = kInfinity;
  for (const Box& box : obstacles.boxes) nearest = std::min(nearest, box_range(box, p, d));
  for (const TriangleMesh& mesh : obstacles.meshes) {
    const auto vertex = [&](std::uint32_t i) {
      return Eigen::Vector3d(mesh.vertices[i][0], mesh.vertices[i][1], mesh.vertices[i][2]);
    };
    for (const auto& t : mesh.triangles) {
      nearest = std::min(nearest, triangle_range(vertex(t[0]), vertex(t[1]), vertex(t[2]), p, d));
    }
  }
  return nearest;
}

std::vector<RayHit> trace(const DenseMap& map, const Sensor& sensor, const GainConfig& config,
                          const Pose& T_world_camera, const Obstacles& obstacles) {
  RayLimits limits = limits_of(map, sensor, config);
  std::vector<RayHit> hits;
  for (const Ray& ray : view_rays(map.T_world_grid, map.voxel_size, sensor.camera,
                                  config.pixel_stride, T_world_camera)) {
    limits.obstacle_range = obstacle_range(map, obstacles, ray);
    hits.push_back(first_hit(map, ray, limits));
  }
  return hits;
}

Eigen::Matrix3d information_of(const Sensor& sensor, const Eigen::Vector3d& d, double range) {
  const MeasurementSigmas s = sensor.sigmas(range);
  const Eigen::Matrix3d along = d * d.transpose();
  return (s.lateral * s.lateral * (Eigen::Matrix3d::Identity() - along) + s.axial * s.axial * along)
      .inverse();
}

double weight_of(const GainConfig& config, double voxel_size, Index3 v) {
  double weight = 1;
  for (const GainConfig::WeightRegion& region : config.weights) {
    if (region.box.contains((v.x + 0.5) * voxel_size, (v.y + 0.5) * voxel_size,
                            (v.z + 0.5) * voxel_size)) {
      weight = region.weight;
    }
  }
  return weight;
}

}  // namespace viewgain::oracle
