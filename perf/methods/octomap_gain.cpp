// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "octomap_gain.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace viewgain::bench {
namespace {

class OctomapGain final : public TraceMethod {
 public:
  OctomapGain(const TraceTask& task, std::shared_ptr<const octomap::OcTree> tree)
      : TraceMethod("octomap_gain", task.sensor.camera.ray_table().size()),
        map_(task.map),
        max_range_(task.sensor.max_range),
        tree_(std::move(tree)) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
  }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    double gain = 0;
    const Eigen::Matrix3d R = T_world_camera.rotation();
    octomap::KeyRay keys;
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      endings[i] = kMiss;
      gain += add_ray(T_world_camera.translation(), R * directions_[i], keys, endings[i]);
    }
    // Keeps the sum from being optimised away, and is what it must be.
    if (!(gain >= 0)) throw std::runtime_error("octomap_gain: the sum of entropies is negative");
  }

 private:
  /// The ray's entropies [nat].
  double add_ray(const Eigen::Vector3d& eye, const Eigen::Vector3d& d, octomap::KeyRay& keys,
                 Ending& ending) const {
    const auto segment = clip_to_workspace(map_, eye, eye + max_range_ * d);
    if (!segment) return 0;
    const octomap::point3d begin = octomap_point(segment->begin);
    octomap::point3d end;
    tree_->castRay(begin, octomap_point(d), end, false);
    octomap::OcTreeKey last;
    if (!tree_->coordToKeyChecked(end, last)) return 0;
    // Past the workspace everything is unknown to OctoMap, nothing is there to us.
    const Index3 voxel = voxel_of(last);
    const bool is_inside = map_.inside(voxel);
    if (is_inside) ending = static_cast<Ending>(map_.position(voxel));
    if (!is_inside) end = octomap_point(segment->end);
    if (!tree_->computeRayKeys(begin, end, keys)) return 0;
    double sum = 0;
    for (const octomap::OcTreeKey& key : keys) sum += entropy_of(key);
    if (is_inside) sum += entropy_of(last);  // which computeRayKeys leaves out
    return sum;
  }

  [[nodiscard]] double entropy_of(const octomap::OcTreeKey& key) const {
    const octomap::OcTreeNode* node = tree_->search(key);
    if (node == nullptr) return std::numbers::ln2;
    const double p = node->getOccupancy();
    return -p * std::log(p) - (1 - p) * std::log(1 - p);
  }

  const oracle::DenseMap& map_;
  double max_range_;  ///< [m]
  std::shared_ptr<const octomap::OcTree> tree_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace

std::unique_ptr<TraceMethod> make_octomap_gain(const TraceTask& task,
                                               std::shared_ptr<const octomap::OcTree> tree) {
  return std::make_unique<OctomapGain>(task, std::move(tree));
}

}  // namespace viewgain::bench
