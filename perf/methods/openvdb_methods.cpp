// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "openvdb_methods.hpp"

#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>
#include <openvdb/tree/ValueAccessor.h>

#include <optional>
#include <utility>

namespace viewgain::bench {
namespace {

using VdbRay = openvdb::math::Ray<double>;
using Accessor = openvdb::tree::ValueAccessor<const openvdb::MaskTree>;

/// The voxels that are not free as active ones, and the workspace in index coordinates.
struct Mask {
  openvdb::MaskGrid::Ptr grid = openvdb::MaskGrid::create();
  openvdb::MaskTree& tree = grid->tree();
  openvdb::BBoxd box;

  explicit Mask(const oracle::DenseMap& map) {
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(tree);
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
    tree.prune();
    const Index3 low = map.min_index;
    box = openvdb::BBoxd(
        {low.x * 1.0, low.y * 1.0, low.z * 1.0},
        {low.x + map.dims.x * 1.0, low.y + map.dims.y * 1.0, low.z + map.dims.z * 1.0});
  }
};

class VdbMethod : public TraceMethod {
 public:
  VdbMethod(std::string name, const TraceTask& task, std::shared_ptr<const Mask> mask)
      : TraceMethod(std::move(name), task.sensor.camera.ray_table().size()),
        mask_(std::move(mask)),
        map_(task.map),
        T_grid_world_(task.map.T_world_grid.inverse()),
        max_range_(task.sensor.max_range / task.map.voxel_size) {
    for (const Eigen::Vector3d& d : task.sensor.camera.ray_table()) {
      directions_.push_back(d.normalized());
    }
  }

 protected:
  /// Calls ending_of(ray) for each ray of the view, clipped to the workspace.
  template <typename EndingOf>
  void for_each_ray(const Pose& T_world_camera, std::span<Ending> endings,
                    const EndingOf& ending_of) const {
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Eigen::Vector3d o = T_grid_camera.translation() / map_.voxel_size;
    const Eigen::Matrix3d R = T_grid_camera.rotation();
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const Eigen::Vector3d d = R * directions_[i];
      VdbRay ray({o.x(), o.y(), o.z()}, {d.x(), d.y(), d.z()}, 0.0, max_range_);
      endings[i] = ray.clip(mask_->box) ? ending_of(ray) : kMiss;
    }
  }
  /// Of the voxel in which a ray ends: a step that falls on the far face may name one outside,
  /// where a tile may reach.
  [[nodiscard]] Ending ending_at(int x, int y, int z) const {
    const Index3 voxel{x, y, z};
    return map_.inside(voxel) ? static_cast<Ending>(map_.position(voxel)) : kMiss;
  }

  std::shared_ptr<const Mask> mask_;

 private:
  const oracle::DenseMap& map_;
  Pose T_grid_world_;
  double max_range_;  ///< [voxel]
  std::vector<Eigen::Vector3d> directions_;
};

class OpenvdbMethod : public VdbMethod {
 public:
  using VdbMethod::VdbMethod;

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const final {
    const Accessor accessor(mask_->tree);
    for_each_ray(T_world_camera, endings,
                 [&](const VdbRay& ray) { return ending_of(ray, accessor); });
  }

 protected:
  /// Where a ray that has been clipped to the workspace ends.
  [[nodiscard]] virtual Ending ending_of(const VdbRay& ray, const Accessor& accessor) const = 0;

  /// Voxel by voxel between the ray's times; nothing if none is active.
  [[nodiscard]] std::optional<Ending> first_active(const VdbRay& ray,
                                                   const Accessor& accessor) const {
    openvdb::math::DDA<VdbRay, 0> dda(ray);
    do {
      if (!accessor.isValueOn(dda.voxel())) continue;
      const openvdb::Coord& c = dda.voxel();
      return ending_at(c.x(), c.y(), c.z());
    } while (dda.step());
    return std::nullopt;
  }
};

class OpenvdbDda final : public OpenvdbMethod {
 public:
  using OpenvdbMethod::OpenvdbMethod;

 private:
  [[nodiscard]] Ending ending_of(const VdbRay& ray, const Accessor& accessor) const override {
    return first_active(ray, accessor).value_or(kMiss);
  }
};

class OpenvdbHdda final : public OpenvdbMethod {
 public:
  using OpenvdbMethod::OpenvdbMethod;

 private:
  using Hdda = openvdb::math::VolumeHDDA<openvdb::MaskTree, VdbRay,
                                         openvdb::MaskTree::RootNodeType::ChildNodeType::LEVEL>;

  [[nodiscard]] Ending ending_of(const VdbRay& ray, const Accessor& accessor) const override {
    Hdda hdda;
    VdbRay part = ray;  // march() changes its times
    for (double begin = ray.t0();;) {
      part.setTimes(begin, ray.t1());
      const VdbRay::TimeSpan leaves = hdda.march(part, accessor);
      if (!leaves.valid()) return kMiss;
      part.setTimes(leaves.t0, leaves.t1);
      if (const auto ending = first_active(part, accessor)) return *ending;
      begin = leaves.t1;
    }
  }
};

/// What nanovdb::HDDA asks of a ray, in double precision throughout, which nanovdb::Ray is not.
class NanovdbRay {
 public:
  using RealType = double;
  using Vec3Type = nanovdb::Vec3d;

  explicit NanovdbRay(const VdbRay& ray)
      : eye_(ray.eye()[0], ray.eye()[1], ray.eye()[2]),
        dir_(ray.dir()[0], ray.dir()[1], ray.dir()[2]),
        inverse_(1 / dir_[0], 1 / dir_[1], 1 / dir_[2]),
        t0_(ray.t0()),
        t1_(ray.t1()) {}

  [[nodiscard]] double t0() const { return t0_; }
  [[nodiscard]] double t1() const { return t1_; }
  [[nodiscard]] const Vec3Type& dir() const { return dir_; }
  [[nodiscard]] const Vec3Type& invDir() const { return inverse_; }
  [[nodiscard]] Vec3Type operator()(double t) const { return eye_ + t * dir_; }

 private:
  Vec3Type eye_, dir_, inverse_;
  double t0_, t1_;
};

class NanovdbHdda final : public VdbMethod {
 public:
  NanovdbHdda(const TraceTask& task, std::shared_ptr<const Mask> mask)
      : VdbMethod("nanovdb_hdda", task, std::move(mask)),
        handle_(nanovdb::openToNanoVDB(*mask_->grid)) {}

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const auto accessor = handle_.grid<nanovdb::ValueMask>()->tree().getAccessor();
    for_each_ray(T_world_camera, endings, [&](const VdbRay& of_vdb) {
      const NanovdbRay ray(of_vdb);
      auto voxel = nanovdb::RoundDown<nanovdb::Coord>(ray(ray.t0()));
      // As nanovdb::firstActive(), whose steps reach 1.0001 voxels beyond a face and so leave
      // voxels out.
      nanovdb::HDDA<NanovdbRay> hdda(ray, static_cast<int>(accessor.getDim(voxel, ray)));
      while (!accessor.isActive(voxel)) {
        if (!hdda.step()) return kMiss;
        voxel = hdda.dim() == 1 ? hdda.voxel()
                                : nanovdb::RoundDown<nanovdb::Coord>(ray(hdda.time() + kBeyond));
        hdda.update(ray, static_cast<int>(accessor.getDim(voxel, ray)));
      }
      return ending_at(voxel[0], voxel[1], voxel[2]);
    });
  }

 private:
  static constexpr double kBeyond = 1e-6;  // a face [voxel]

  nanovdb::GridHandle<> handle_;
};

}  // namespace

std::vector<std::unique_ptr<TraceMethod>> make_openvdb_methods(const TraceTask& task) {
  openvdb::initialize();
  const auto mask = std::make_shared<const Mask>(task.map);
  std::vector<std::unique_ptr<TraceMethod>> methods;
  methods.push_back(std::make_unique<OpenvdbDda>("openvdb_dda", task, mask));
  methods.push_back(std::make_unique<OpenvdbHdda>("openvdb_hdda", task, mask));
  methods.push_back(std::make_unique<NanovdbHdda>(task, mask));
  return methods;
}

}  // namespace viewgain::bench
