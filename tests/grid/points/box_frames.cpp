// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "box_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/analytic_frames.hpp"

namespace viewgain::test {
namespace {

using Eigen::Vector3d;

constexpr double kRoom = 0.6;  // half of the cube of walls around [m]

}  // namespace

double range_to_box(const Vector3d& eye, const Vector3d& ray, const Vector3d& half, bool inside) {
  double enters = -std::numeric_limits<double>::infinity(), leaves = -enters;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double at = -half[a] / ray[a] - eye[a] / ray[a], to = half[a] / ray[a] - eye[a] / ray[a];
    enters = std::max(enters, std::min(at, to));
    leaves = std::min(leaves, std::max(at, to));
  }
  if (inside) return leaves;
  return enters <= leaves && enters > 0 ? enters : std::numeric_limits<double>::infinity();
}

Sensor box_camera(double noise) {
  Sensor sensor = small_sensor(88, 72);
  sensor.noise = ConstantNoise{noise, noise};
  sensor.min_range = 0.05;
  return sensor;
}

DepthFrame see_box(const Sensor& sensor, const Pose& T_world_camera, const Vector3d& half,
                   std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vector3d eye = T_world_camera.translation();
  DepthFrame frame{sensor.camera.width, sensor.camera.height, {}};
  for (const Vector3d& ray : sensor.camera.ray_table()) {
    const auto depth_along = [&](double x, double y) {
      const Vector3d way = T_world_camera.rotation() * Vector3d(x, y, 1);
      return std::min(range_to_box(eye, way, half, false),
                      range_to_box(eye, way, Vector3d::Constant(kRoom), true));
    };
    const double nominal = depth_along(ray.x(), ray.y());
    const double lateral = sensor.noise_sigmas(nominal * ray.norm()).lateral / nominal;
    const double x = ray.x() + lateral * normal(random), y = ray.y() + lateral * normal(random);
    double weights = 0, mean = 0;  // a part's light is as 1 / depth²
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const double depth =
            depth_along(x + i / (3 * sensor.camera.fx), y + j / (3 * sensor.camera.fy));
        weights += 1 / (depth * depth);
        mean += 1 / depth;
      }
    }
    mean /= weights;
    const double axial = sensor.noise_sigmas(mean * ray.norm()).axial;
    frame.depth.push_back(static_cast<float>(mean + axial * normal(random) / ray.norm()));
  }
  return frame;
}

}  // namespace viewgain::test
