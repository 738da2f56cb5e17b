// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "octomap_integrate.hpp"

#include <cmath>

namespace viewgain::bench {
OctomapIntegrator::OctomapIntegrator(const Sensor& sensor, const oracle::DenseMap& frame_of)
    : map_(frame_of),
      min_range_(sensor.min_range),
      max_range_(sensor.max_range),
      directions_(sensor.camera.ray_table()) {}

void OctomapIntegrator::integrate(octomap::OcTree& tree, const DepthFrame& frame,
                                  const Pose& T_world_camera) {
  const Eigen::Matrix3d R = T_world_camera.rotation();
  const Eigen::Vector3d eye = T_world_camera.translation();
  octomap::KeySet crossed;
  octomap::KeySet hit;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const auto depth = static_cast<double>(frame.depth[i]);
    const double per_depth = directions_[i].norm();
    const double range = depth * per_depth;
    if (depth == 0 || range < min_range_) continue;
    const bool is_reading = range <= max_range_;
    const double reach = is_reading ? range : max_range_;
    const Eigen::Vector3d end = eye + reach / per_depth * (R * directions_[i]);
    const auto segment = clip_to_workspace(map_, eye, end);
    if (!segment) continue;
    const octomap::point3d last = octomap_point(segment->end);
    if (!tree.computeRayKeys(octomap_point(segment->begin), last, ray_)) continue;
    crossed.insert(ray_.begin(), ray_.end());
    // computeRayKeys leaves out the last cell: the reading's, or one more that was crossed.
    const octomap::OcTreeKey last_key = tree.coordToKey(last);
    (is_reading && !segment->leaves ? hit : crossed).insert(last_key);
  }
  for (const octomap::OcTreeKey& key : crossed) {
    if (hit.count(key) == 0) tree.updateNode(key, false, true);
  }
  for (const octomap::OcTreeKey& key : hit) tree.updateNode(key, true, true);
  tree.updateInnerOccupancy();
}

}  // namespace viewgain::bench
