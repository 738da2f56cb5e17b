// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "openvdb_dda.hpp"

#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <vector>

namespace viewgain::bench {
namespace {

using VdbRay = openvdb::math::Ray<double>;
using VdbDda = openvdb::math::DDA<VdbRay, 0>;

class OpenvdbDda final : public TraceMethod {
 public:
  explicit OpenvdbDda(const TraceTask& task)
      : TraceMethod("openvdb_dda", task.sensor.camera.ray_table().size()),
        map_(task.map),
        T_grid_world_(task.map.T_world_grid.inverse()),
        max_range_(task.sensor.max_range / task.map.voxel_size) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(tree_);
    for (int x = 0; x < map_.dims.x; ++x) {
      for (int y = 0; y < map_.dims.y; ++y) {
        for (int z = 0; z < map_.dims.z; ++z) {
          const Index3 voxel{map_.min_index.x + x, map_.min_index.y + y, map_.min_index.z + z};
          if (map_.state(voxel) != VoxelState::free) {
            accessor.setValueOn(openvdb::Coord(voxel.x, voxel.y, voxel.z));
          }
        }
      }
    }
    tree_.prune();
    const Index3 low = map_.min_index;
    box_ = openvdb::BBoxd(
        {low.x * 1.0, low.y * 1.0, low.z * 1.0},
        {low.x + map_.dims.x * 1.0, low.y + map_.dims.y * 1.0, low.z + map_.dims.z * 1.0});
  }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    openvdb::tree::ValueAccessor<const openvdb::MaskTree> accessor(tree_);
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Eigen::Vector3d o = T_grid_camera.translation() / map_.voxel_size;
    const Eigen::Matrix3d R = T_grid_camera.rotation();
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const Eigen::Vector3d d = R * directions_[i];
      VdbRay ray({o.x(), o.y(), o.z()}, {d.x(), d.y(), d.z()}, 0.0, max_range_);
      endings[i] = kMiss;
      if (!ray.clip(box_)) continue;
      VdbDda dda(ray);
      do {
        if (!accessor.isValueOn(dda.voxel())) continue;
        const openvdb::Coord& c = dda.voxel();
        const Index3 voxel{c.x(), c.y(), c.z()};
        // A step that falls on the far face may name a voxel outside, where a tile may reach.
        if (map_.inside(voxel)) endings[i] = static_cast<Ending>(map_.position(voxel));
        break;
      } while (dda.step());
    }
  }

 private:
  const oracle::DenseMap& map_;
  Pose T_grid_world_;
  double max_range_;  ///< [voxel]
  std::vector<Eigen::Vector3d> directions_;
  openvdb::MaskTree tree_;
  openvdb::BBoxd box_;
};

}  // namespace

std::unique_ptr<TraceMethod> make_openvdb_dda(const TraceTask& task) {
  openvdb::initialize();
  return std::make_unique<OpenvdbDda>(task);
}

}  // namespace viewgain::bench
