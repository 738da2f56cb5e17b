// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "nanovdb_method.hpp"

#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/Ray.h>
#include <openvdb/openvdb.h>

#include <utility>
#include <vector>

namespace viewgain::bench {
namespace {

using NanoRay = nanovdb::Ray<double>;
using Vec3 = nanovdb::Vec3<double>;

constexpr double kBeyond = 1e-6;  // a face [voxel]

nanovdb::GridHandle<> grid_of(const oracle::DenseMap& map) {
  openvdb::MaskGrid mask;
  auto accessor = mask.getAccessor();
  for (int x = 0; x < map.dims.x; ++x) {
    for (int y = 0; y < map.dims.y; ++y) {
      for (int z = 0; z < map.dims.z; ++z) {
        const Index3 voxel{map.min_index.x + x, map.min_index.y + y, map.min_index.z + z};
        if (map.state(voxel) != VoxelState::free) {
          accessor.setValueOn(openvdb::Coord(voxel.x, voxel.y, voxel.z));
        }
      }
    }
  }
  mask.tree().prune();
  return nanovdb::openToNanoVDB(mask);
}

class NanovdbHdda final : public TraceMethod {
 public:
  explicit NanovdbHdda(const TraceTask& task)
      : TraceMethod("nanovdb_hdda", task.sensor.camera.ray_table().size()),
        map_(task.map),
        T_grid_world_(task.map.T_world_grid.inverse()),
        max_range_(task.sensor.max_range / task.map.voxel_size),
        handle_(grid_of(task.map)),
        grid_(handle_.grid<nanovdb::ValueMask>()) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
    const Index3 low = map_.min_index, n = map_.dims;
    box_ = {Vec3(low.x, low.y, low.z), Vec3(low.x + n.x, low.y + n.y, low.z + n.z)};
  }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const auto accessor = grid_->getAccessor();
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Eigen::Vector3d o = T_grid_camera.translation() / map_.voxel_size;
    const Eigen::Matrix3d R = T_grid_camera.rotation();
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const Eigen::Vector3d d = R * directions_[i];
      NanoRay ray(Vec3(o.x(), o.y(), o.z()), Vec3(d.x(), d.y(), d.z()), 0.0, max_range_);
      endings[i] = ray.clip(box_) ? ending_of(ray, accessor) : kMiss;
    }
  }

 private:
  template <typename Accessor>
  [[nodiscard]] Ending ending_of(const NanoRay& ray, const Accessor& accessor) const {
    const auto voxel_at = [&](double t) {
      return nanovdb::RoundDown<nanovdb::Coord>(ray(t + kBeyond));
    };
    nanovdb::Coord at = voxel_at(ray.t0());
    nanovdb::HDDA<NanoRay> walk(ray, static_cast<int>(accessor.getDim(at, ray)));
    while (!accessor.isActive(at)) {
      if (!walk.step()) return kMiss;
      at = voxel_at(walk.time());
      walk.update(ray, static_cast<int>(accessor.getDim(at, ray)));
    }
    const Index3 voxel{at.x(), at.y(), at.z()};
    return map_.inside(voxel) ? static_cast<Ending>(map_.position(voxel)) : kMiss;
  }

  const oracle::DenseMap& map_;
  Pose T_grid_world_;
  double max_range_;  // [voxel]
  std::vector<Eigen::Vector3d> directions_;
  nanovdb::GridHandle<> handle_;
  const nanovdb::NanoGrid<nanovdb::ValueMask>* grid_;
  nanovdb::BBox<Vec3> box_;  // the workspace, index coordinates
};

}  // namespace

std::unique_ptr<TraceMethod> make_nanovdb_method(const TraceTask& task) {
  openvdb::initialize();
  return std::make_unique<NanovdbHdda>(task);
}

}  // namespace viewgain::bench
