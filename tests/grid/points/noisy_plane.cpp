// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "noisy_plane.hpp"

#include <Eigen/Core>

#include "core/random_values.hpp"
#include "grid/analytic_frames.hpp"

namespace viewgain::test {

using Eigen::Vector3d;

Sensor plane_sensor() {
  Sensor sensor = small_sensor(64, 64);
  sensor.camera.fx = sensor.camera.fy = 220;
  sensor.camera.cx = sensor.camera.cy = 31.5;
  sensor.noise = ConstantNoise{kSigmaAxial, kSigmaLateral};
  sensor.min_range = 0.1;
  return sensor;
}

BeliefGrid noisy_plane(double voxel, int frames, const Pose& T_world_grid,
                       IntegrationConfig::Occupancy occupancy, int behind, double thickness) {
  const Sensor sensor = plane_sensor();
  BeliefGrid grid({voxel, {{-0.06, -0.06, 0.34}, {0.06, 0.06, 0.46}}, T_world_grid, 0.0072});
  FrameIntegrator integrator(sensor, {IntegrationConfig::Carve::cones, occupancy, {}});
  RandomValues random(7);
  const Pose from_behind(Eigen::Matrix3d(Vector3d(1, -1, -1).asDiagonal()),
                         {0, 0, 2 * kPlaneZ + thickness});
  for (int i = 0; i < frames + behind; ++i) {
    DepthFrame frame{64, 64, {}};
    for (const Vector3d& ray : sensor.camera.ray_table()) {
      const double range = kPlaneZ * ray.norm() + kSigmaAxial * random.normal();
      frame.depth.push_back(static_cast<float>(range / ray.norm()));
    }
    // The camera's frame is the grid's, or looks the other way.
    integrator.integrate(grid, frame, i < frames ? T_world_grid : T_world_grid * from_behind);
  }
  return grid;
}

}  // namespace viewgain::test
