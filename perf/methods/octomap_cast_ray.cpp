// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "octomap_cast_ray.hpp"

#include <utility>
#include <vector>

namespace viewgain::bench {
namespace {

class OctomapCastRay final : public TraceMethod {
 public:
  OctomapCastRay(const TraceTask& task, std::shared_ptr<const octomap::OcTree> tree)
      : TraceMethod("octomap_cast_ray", task.sensor.camera.ray_table().size()),
        map_(task.map),
        max_range_(task.sensor.max_range),
        tree_(std::move(tree)) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
  }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const Eigen::Matrix3d R = T_world_camera.rotation();
    const Eigen::Vector3d eye = T_world_camera.translation();
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const Eigen::Vector3d d = R * directions_[i];
      endings[i] = kMiss;
      const auto segment = clip_to_workspace(map_, eye, eye + max_range_ * d);
      if (!segment) continue;
      octomap::point3d end;
      tree_->castRay(octomap_point(segment->begin), octomap_point(d), end, false);
      octomap::OcTreeKey key;
      if (!tree_->coordToKeyChecked(end, key)) continue;
      const Index3 voxel = voxel_of(key);
      // Past the workspace everything is unknown to OctoMap, nothing is there to us.
      if (map_.inside(voxel)) endings[i] = static_cast<Ending>(map_.position(voxel));
    }
  }

 private:
  const oracle::DenseMap& map_;
  double max_range_;  ///< [m]
  std::shared_ptr<const octomap::OcTree> tree_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace

std::unique_ptr<TraceMethod> make_octomap_cast_ray(const TraceTask& task,
                                                   std::shared_ptr<const octomap::OcTree> tree) {
  return std::make_unique<OctomapCastRay>(task, std::move(tree));
}

}  // namespace viewgain::bench
