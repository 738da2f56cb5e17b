// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "octomap_methods.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace viewgain::bench {
namespace {

class OctomapMethod : public TraceMethod {
 public:
  OctomapMethod(std::string name, const TraceTask& task,
                std::shared_ptr<const octomap::OcTree> tree)
      : TraceMethod(std::move(name), task.sensor.camera.ray_table().size()),
        map_(task.map),
        max_range_(task.sensor.max_range),
        tree_(std::move(tree)) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
  }

 protected:
  /// A ray inside the workspace, up to where castRay ends it or to the workspace's far side.
  struct Cast {
    octomap::point3d begin;
    octomap::point3d end;
    octomap::OcTreeKey last;  ///< of the voxel that castRay names
    Ending ending = kMiss;    ///< that voxel, if it is in the workspace
  };

  /// Fills `endings` and calls visit(Cast) for each ray that enters the workspace.
  template <typename Visit>
  void cast_all(const Pose& T_world_camera, std::span<Ending> endings, Visit&& visit) const {
    const Eigen::Matrix3d R = T_world_camera.rotation();
    const Eigen::Vector3d eye = T_world_camera.translation();
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const Eigen::Vector3d d = R * directions_[i];
      endings[i] = kMiss;
      const auto segment = clip_to_workspace(map_, eye, eye + max_range_ * d);
      if (!segment) continue;
      Cast cast{octomap_point(segment->begin), {}, {}};
      tree_->castRay(cast.begin, octomap_point(d), cast.end, false);
      if (!tree_->coordToKeyChecked(cast.end, cast.last)) continue;
      const Index3 voxel = voxel_of(cast.last);
      if (map_.inside(voxel)) {
        endings[i] = cast.ending = static_cast<Ending>(map_.position(voxel));
      } else {
        // Past the workspace everything is unknown to OctoMap, nothing is there to us.
        cast.end = octomap_point(segment->end);
      }
      visit(cast);
    }
  }

  [[nodiscard]] const octomap::OcTree& tree() const { return *tree_; }

 private:
  const oracle::DenseMap& map_;
  double max_range_;  ///< [m]
  std::shared_ptr<const octomap::OcTree> tree_;
  std::vector<Eigen::Vector3d> directions_;
};

class OctomapCastRay final : public OctomapMethod {
 public:
  using OctomapMethod::OctomapMethod;

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    cast_all(T_world_camera, endings, [](const Cast&) {});
  }
};

class OctomapGain final : public OctomapMethod {
 public:
  using OctomapMethod::OctomapMethod;

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    double gain = 0;
    octomap::KeyRay keys;
    cast_all(T_world_camera, endings, [&](const Cast& cast) { gain += entropy_along(cast, keys); });
    // Keeps the sum from being optimised away, and is what it must be.
    if (!(gain >= 0)) throw std::runtime_error("octomap_gain: the sum of entropies is negative");
  }

 private:
  /// The ray's entropies [nat].
  double entropy_along(const Cast& cast, octomap::KeyRay& keys) const {
    if (!tree().computeRayKeys(cast.begin, cast.end, keys)) return 0;
    double sum = 0;
    for (const octomap::OcTreeKey& key : keys) sum += entropy_of(key);
    if (cast.ending != kMiss) sum += entropy_of(cast.last);  // which computeRayKeys leaves out
    return sum;
  }

  [[nodiscard]] double entropy_of(const octomap::OcTreeKey& key) const {
    const octomap::OcTreeNode* node = tree().search(key);
    if (node == nullptr) return std::numbers::ln2;
    const double p = node->getOccupancy();
    return -p * std::log(p) - (1 - p) * std::log(1 - p);
  }
};

}  // namespace

std::vector<std::unique_ptr<TraceMethod>> make_octomap_methods(const TraceTask& task) {
  const std::shared_ptr<const octomap::OcTree> tree = octree_of(task.map);
  std::vector<std::unique_ptr<TraceMethod>> methods;
  methods.push_back(std::make_unique<OctomapCastRay>("octomap_cast_ray", task, tree));
  methods.push_back(std::make_unique<OctomapGain>("octomap_gain", task, tree));
  return methods;
}

}  // namespace viewgain::bench
