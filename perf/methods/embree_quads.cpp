// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "embree_quads.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "exposed_quads.hpp"
#include "trace/device.hpp"
#include "trace/embree_compat.hpp"
#include "trace/ray_tile.hpp"

namespace viewgain::bench {
namespace {

/// The quads in a BVH; geometry number = axis that its quads are perpendicular to.
class QuadScene {
 public:
  QuadScene(const TraceTask& task, bool merged, bool robust)
      : device_(detail::shared_device(select_isa())), scene_(rtcNewScene(device_)) {
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene_.get(), robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const auto quads = exposed_quads(task.map, merged ? std::numeric_limits<int>::max() / 2 : 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      attach(static_cast<unsigned>(axis), quads[axis]);
      for (const Quad& quad : quads[axis]) behind_[axis].push_back(voxels_behind(quad, axis));
    }
    detail::commit_scene(device_, scene_, quads[0].size() + quads[1].size() + quads[2].size(),
                         "building the quads");
  }

  [[nodiscard]] RTCScene get() const { return scene_.get(); }

  /// First and last voxel along each axis behind a quad, relative to the workspace's lowest one.
  struct Voxels {
    std::array<int, 3> first;
    std::array<int, 3> last;
  };
  [[nodiscard]] const Voxels& behind(unsigned axis, unsigned quad) const {
    return behind_[axis][quad];
  }

 private:
  void attach(unsigned axis, const std::vector<Quad>& quads) {
    if (quads.empty()) return;
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), 4 * quads.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), quads.size()));
    detail::check_device(device_, "storing the quads");
    for (std::size_t i = 0; i < 4 * quads.size(); ++i) {
      indices[i] = static_cast<unsigned>(i);
      for (std::size_t k = 0; k < 3; ++k) vertices[3 * i + k] = quads[i / 4].corners[i % 4][k];
    }
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_.get(), geometry, axis);
    rtcReleaseGeometry(geometry);
  }

  static Voxels voxels_behind(const Quad& quad, std::size_t axis) {
    Voxels voxels{};
    for (std::size_t k = 0; k < 3; ++k) {
      voxels.first[k] = static_cast<int>(quad.corners[0][k]);
      voxels.last[k] = static_cast<int>(quad.corners[2][k]) - 1;
    }
    const int layer = quad.is_lower_side ? voxels.first[axis] : voxels.first[axis] - 1;
    voxels.first[axis] = voxels.last[axis] = layer;
    return voxels;
  }

  RTCDevice device_;
  detail::ScenePtr scene_;
  std::array<std::vector<Voxels>, 3> behind_;
};

/// kWidth rays a packet.
template <int kWidth>
class EmbreeQuads final : public TraceMethod {
  using Packet = std::conditional_t<kWidth == 16, RTCRayHit16, RTCRayHit8>;

 public:
  EmbreeQuads(std::string name, std::shared_ptr<const QuadScene> scene, const TraceTask& task,
              bool coherent)
      : TraceMethod(std::move(name), static_cast<std::size_t>(task.sensor.camera.width) *
                                         static_cast<std::size_t>(task.sensor.camera.height)),
        scene_(std::move(scene)),
        table_(task.sensor.camera, 1),
        T_grid_world_(task.map.T_world_grid.inverse()),
        voxel_size_(task.map.voxel_size),
        base_(task.map.min_index.x, task.map.min_index.y, task.map.min_index.z),
        dims_{task.map.dims.x, task.map.dims.y, task.map.dims.z},
        max_range_(static_cast<float>(task.sensor.max_range / task.map.voxel_size)),
        coherent_(coherent) {}

  [[nodiscard]] RayShares shares(std::span<const Pose>) const override { return {0, 1}; }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Eigen::Vector3f origin =
        (T_grid_camera.translation() / voxel_size_ - base_).cast<float>();
    const Eigen::Matrix3f R = T_grid_camera.rotation().cast<float>();
    detail::RayQuery query(coherent_);
    alignas(64) Packet packet;
    alignas(64) int valid[kWidth];
    for (int i = 0; i < kWidth; ++i) {
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.tnear[i] = 0;
      packet.ray.time[i] = 0;
      packet.ray.mask[i] = 0xFFFFFFFFU;
      packet.ray.flags[i] = 0;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    for (std::size_t tile = 0; tile < table_.tile_count; ++tile) {
      for (int first = 0; first < detail::kTileRays; first += kWidth) {
        const float* x = &table_.directions[tile * 3 * detail::kTileRays] + first;
        const float* y = x + detail::kTileRays;
        const float* z = y + detail::kTileRays;
        for (int i = 0; i < kWidth; ++i) {
          packet.ray.dir_x[i] = R(0, 0) * x[i] + R(0, 1) * y[i] + R(0, 2) * z[i];
          packet.ray.dir_y[i] = R(1, 0) * x[i] + R(1, 1) * y[i] + R(1, 2) * z[i];
          packet.ray.dir_z[i] = R(2, 0) * x[i] + R(2, 1) * y[i] + R(2, 2) * z[i];
          packet.ray.tfar[i] = max_range_;
          packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
          valid[i] = (table_.valid[tile] >> (first + i) & 1) != 0 ? -1 : 0;
        }
        intersect(valid, packet, query);
        store(packet, origin, tile, first, endings);
      }
    }
  }

 private:
  void intersect(const int* valid, Packet& packet, detail::RayQuery& query) const {
    if constexpr (kWidth == 16) {
      detail::intersect16(valid, scene_->get(), &packet, &query);
    } else {
      detail::intersect8(valid, scene_->get(), &packet, &query);
    }
  }

  /// The voxel behind the entry face at the hit point, which rounding may put beside the quad.
  void store(const Packet& packet, const Eigen::Vector3f& origin, std::size_t tile, int first,
             std::span<Ending> endings) const {
    for (int i = 0; i < kWidth; ++i) {
      if ((table_.valid[tile] >> (first + i) & 1) == 0) continue;
      Ending& ending = endings[table_.ray_index(tile, first + i)];
      ending = kMiss;
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const auto& behind = scene_->behind(packet.hit.geomID[i], packet.hit.primID[i]);
      const float t = packet.ray.tfar[i];
      const auto index = [&](std::size_t k, float o, float d) {
        return std::clamp(static_cast<int>(o + t * d), behind.first[k], behind.last[k]);
      };
      const int x = index(0, origin.x(), packet.ray.dir_x[i]);
      const int y = index(1, origin.y(), packet.ray.dir_y[i]);
      const int z = index(2, origin.z(), packet.ray.dir_z[i]);
      ending = (x * dims_[1] + y) * dims_[2] + z;
    }
  }

  std::shared_ptr<const QuadScene> scene_;
  detail::TileTable table_;
  Pose T_grid_world_;
  double voxel_size_;  ///< [m]
  Eigen::Vector3d base_;
  std::array<int, 3> dims_;
  float max_range_;  ///< [voxel]
  bool coherent_;
};

}  // namespace

std::vector<std::unique_ptr<TraceMethod>> make_embree_quads(const TraceTask& task) {
  std::vector<std::unique_ptr<TraceMethod>> methods;
  struct Kind {
    const char* name;
    bool merged, robust;
  };
  for (const Kind& kind : {Kind{"single robust", false, true}, Kind{"merged robust", true, true},
                           Kind{"merged fast", true, false}}) {
    const auto scene = std::make_shared<const QuadScene>(task, kind.merged, kind.robust);
    for (const bool coherent : {true, false}) {
      const std::string name = std::string(kind.name) + (coherent ? " coherent" : " incoherent");
      methods.push_back(std::make_unique<EmbreeQuads<8>>(name + " 8", scene, task, coherent));
      methods.push_back(std::make_unique<EmbreeQuads<16>>(name + " 16", scene, task, coherent));
    }
  }
  return methods;
}

}  // namespace viewgain::bench
