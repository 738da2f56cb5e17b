// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "realised_area.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

constexpr double kPlaneSigmas = 3;  // of integration, too

bool sees_plane(const Sensor& sensor, const Eigen::Vector3d& point, const Eigen::Vector3d& sight,
                double plane) {
  const double height = point.z() - plane;
  if (height < 0) return true;
  const double range = sight.norm(), fall = -sight.z() / range;  // also cosθ on the plane
  return fall > 0 && height / fall < kPlaneSigmas * sensor.sigmas(range, fall).axial;
}

}  // namespace

RealisedArea::RealisedArea(const Sensor& sensor, std::optional<double> support_plane)
    : sensor_(sensor),
      support_plane_(support_plane),
      rays_(sensor.camera.ray_table()),
      solid_angles_(sensor.camera.solid_angles(rays_)) {}

double RealisedArea::of(const DepthFrame& frame, const Pose& T_world_camera,
                        const BeliefGrid& before, const HazardField* hazard) const {
  const PinholeCamera& camera = sensor_.camera;
  if (frame.width != camera.width || frame.height != camera.height ||
      frame.depth.size() != rays_.size()) {
    throw Error(ErrorCode::invalid_argument,
                "the frame is " + std::to_string(frame.width) + " x " +
                    std::to_string(frame.height) + " px with " +
                    std::to_string(frame.depth.size()) + " depths, the sensor " +
                    std::to_string(camera.width) + " x " + std::to_string(camera.height) + " px");
  }
  double area = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const float z = frame.depth[i];
    if (!(z > 0) || !std::isfinite(z) || !rays_[i].allFinite()) continue;
    const Eigen::Vector3d p_camera = static_cast<double>(z) * rays_[i];
    const double range = p_camera.norm();
    if (range < sensor_.min_range || range > sensor_.max_range) continue;
    const Eigen::Vector3d point = T_world_camera * p_camera;
    if (support_plane_ &&
        sees_plane(sensor_, point, point - T_world_camera.translation(), *support_plane_)) {
      continue;
    }
    const std::optional<Index3> voxel = before.index_of(point);
    if (!voxel || before.state(*voxel) != VoxelState::unknown) continue;
    if (hazard != nullptr && !hazard->is_new(*voxel)) continue;
    area += solid_angles_[i] * range * range;
  }
  return area;
}

}  // namespace viewgain::app
