// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "analytic_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace viewgain::test {

DepthFrame see_spheres(const Sensor& sensor, const Pose& T_world_camera,
                       const std::vector<Sphere>& spheres) {
  DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
  const Eigen::Vector3d eye = T_world_camera.translation();
  for (const Eigen::Vector3d& ray : sensor.camera.ray_table()) {
    const Eigen::Vector3d d = (T_world_camera.rotation() * ray).normalized();
    double nearest = std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : spheres) {
      const Eigen::Vector3d to_center = sphere.center - eye;
      const double along = to_center.dot(d);
      const double inside = sphere.radius * sphere.radius - (to_center - along * d).squaredNorm();
      if (inside < 0) continue;
      for (const double t : {along - std::sqrt(inside), along + std::sqrt(inside)}) {
        if (t > 0) nearest = std::min(nearest, t);
      }
    }
    frame.depth.push_back(std::isfinite(nearest) ? static_cast<float>(nearest / ray.norm())
                                                 : DepthFrame::kOutOfRange);
  }
  return frame;
}

DepthFrame see_plane(const Sensor& sensor, double z0, double slope) {
  DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
  for (const Eigen::Vector3d& ray : sensor.camera.ray_table()) {
    frame.depth.push_back(static_cast<float>(z0 / (1.0 - slope * ray.x())));
  }
  return frame;
}

std::vector<Sphere> three_spheres_in_a_room() {
  return {{{0.00, 0.00, 0.00}, 0.09},
          {{0.10, 0.03, 0.05}, 0.06},
          {{-0.09, -0.04, -0.08}, 0.05},
          {{0, 0, 0}, 1.5}};
}

GridConfig object_grid(int n) {
  return {0.4 / n, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.0072};
}

Pose ring_view(int i) {
  const double elevation = 27.0 * std::numbers::pi / 180.0;
  const double azimuth = 46.0 * i * std::numbers::pi / 180.0;
  return look_at(
      0.6 * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation)),
      Eigen::Vector3d::Zero());
}

Sensor small_sensor(int width, int height) {
  Sensor sensor = sensor_preset("sr4000");
  sensor.name = "small";
  sensor.camera.width = width;
  sensor.camera.height = height;
  sensor.camera.fx = 1.02 * width;
  sensor.camera.fy = 1.05 * width;
  sensor.camera.cx = 0.49 * width;
  sensor.camera.cy = 0.52 * height;
  return sensor;
}

}  // namespace viewgain::test
