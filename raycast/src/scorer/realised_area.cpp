// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scorer/realised_area.hpp"

#include <cmath>
#include <cstddef>

#include "gain/frontal_sigmas.hpp"

namespace viewgain::detail {
namespace {

bool sees_plane(const Sensor& sensor, const Eigen::Vector3d& point, const Eigen::Vector3d& sight,
                double plane) {
  const double range = sight.norm(), rise = sight.z() / range;  // its size is cosθ on the plane
  return is_of_plane(point.z() - plane, rise, sensor.sigmas(range, std::abs(rise)));
}

}  // namespace

RealisedArea::RealisedArea(const Sensor& sensor, double voxel_size,
                           std::optional<double> support_plane)
    : sensor_(sensor),
      support_plane_(support_plane),
      rays_(sensor.camera.ray_table()),
      solid_angles_(sensor.camera.solid_angles(rays_)),
      worth_(frontal_sigmas(sensor), sensor.working_distance, voxel_size) {}

double RealisedArea::of(const DepthFrame& frame, const Pose& T_world_camera,
                        const BeliefGrid& before, const HazardField* hazard) const {
  check_frame_size(frame, sensor_.camera);
  double area = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const float z = frame.depth[i];
    if (!(z > 0) || !std::isfinite(z) || !rays_[i].allFinite()) continue;
    const Eigen::Vector3d p_camera = static_cast<double>(z) * rays_[i];
    const double range = p_camera.norm();
    if (range < sensor_.min_range || range > sensor_.max_range) continue;
    if (frame.shows_known(i)) continue;
    const Eigen::Vector3d point = T_world_camera * p_camera;
    if (support_plane_ &&
        sees_plane(sensor_, point, point - T_world_camera.translation(), *support_plane_)) {
      continue;
    }
    const std::optional<Index3> voxel = before.index_of(point);
    if (!voxel || before.state(*voxel) != VoxelState::unknown) continue;
    if (hazard != nullptr && !hazard->is_new(*voxel)) continue;
    area += solid_angles_[i] * range * range * worth_(range);
  }
  return area;
}

}  // namespace viewgain::detail
