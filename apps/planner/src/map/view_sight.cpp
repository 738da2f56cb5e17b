// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/view_sight.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace viewgain {

ViewSight::ViewSight(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
                     std::span<const Pose> views, const ExecConfig& exec)
    : evaluator_(std::move(scene), sensor, {}, exec),
      sensor_(sensor),
      views_(views.begin(), views.end()),
      traced_(views.size()) {}

bool ViewSight::sees(std::size_t view, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p_camera = views_[view].inverse() * point;
  const PinholeCamera& camera = sensor_.camera;
  if (!camera.sees(p_camera)) return false;
  const Eigen::Vector2d pixel = camera.project(p_camera);

  if (!traced_[view]) traced_[view] = evaluator_.trace(views_[view]);
  const std::vector<RayHit>& hits = *traced_[view];
  const double range = p_camera.norm();
  const double slack =
      2 * evaluator_.scene().snapshot().voxel_size + 3 * sensor_.sigmas(range).axial;
  const int u = static_cast<int>(std::lround(pixel.x())),
            v = static_cast<int>(std::lround(pixel.y()));
  for (int row = std::max(v - 1, 0); row <= std::min(v + 1, camera.height - 1); ++row) {
    for (int column = std::max(u - 1, 0); column <= std::min(u + 1, camera.width - 1); ++column) {
      const auto ray = static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(column);
      if (hits[ray].range >= range - slack) return true;
    }
  }
  return false;
}

}  // namespace viewgain
