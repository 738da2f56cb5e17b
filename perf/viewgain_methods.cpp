// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain_methods.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "leaf_traversal.hpp"
#include "ray_tile.hpp"
#include "scene_data.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

class ViewgainGain final : public TraceMethod {
 public:
  ViewgainGain(const TraceTask& task, ScenePointer scene)
      : TraceMethod("viewgain_gain", task.sensor.camera.ray_table().size()),
        map_(task.map),
        evaluator_(std::move(scene), task.sensor, {}, {.num_threads = task.num_threads}) {}

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const std::vector<RayHit> hits = evaluator_.trace(T_world_camera);
    std::transform(hits.begin(), hits.end(), endings.begin(), [&](const RayHit& hit) {
      return hit.kind == RayHit::Kind::none ? kMiss : static_cast<Ending>(map_.position(hit.voxel));
    });
  }

  /// On the evaluator's own threads, as many as the pool has.
  void run(std::span<const Pose> poses, ThreadPool&) override {
    results_.resize(poses.size());
    evaluator_.evaluate(poses, results_);
  }

 private:
  const oracle::DenseMap& map_;
  GainEvaluator evaluator_;
  std::vector<ViewGain> results_;
};

/// Calls the tracing kernel tile by tile.
class ViewgainKernel : public TraceMethod {
 public:
  ViewgainKernel(std::string name, const TraceTask& task, ScenePointer scene)
      : TraceMethod(std::move(name), task.sensor.camera.ray_table().size()),
        map_(task.map),
        scene_(std::move(scene)),
        data_(scene_->data()),
        table_(task.sensor.camera, 1),
        T_grid_world_(task.map.T_world_grid.inverse()),
        min_range_(static_cast<float>(task.sensor.min_range / task.map.voxel_size)),
        max_range_(static_cast<float>(task.sensor.max_range / task.map.voxel_size)) {}

 protected:
  [[nodiscard]] detail::PoseFrame frame_of(const Pose& T_world_camera) const {
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Index3& base = data_.snapshot.min_index;
    const Eigen::Vector3d origin =
        T_grid_camera.translation() / map_.voxel_size - Eigen::Vector3d(base.x, base.y, base.z);
    const Eigen::Matrix3d R = T_grid_camera.rotation();
    detail::PoseFrame frame;
    for (int i = 0; i < 3; ++i) {
      frame.origin[static_cast<std::size_t>(i)] = static_cast<float>(origin[i]);
    }
    for (int i = 0; i < 9; ++i) {
      frame.rotation[static_cast<std::size_t>(i)] = static_cast<float>(R(i / 3, i % 3));
    }
    frame.min_range = min_range_;
    frame.max_range = max_range_;
    return frame;
  }

  /// The endings of a traced tile, in pixel order.
  void store(const detail::RayTile& tile, std::size_t number, std::span<Ending> endings) const {
    for (int lane = 0; lane < detail::kTileRays; ++lane) {
      if ((tile.valid >> lane & 1U) == 0) continue;
      const bool hit = (tile.hit >> lane & 1U) != 0;
      endings[table_.ray_index(number, lane)] =
          hit ? static_cast<Ending>(
                    map_.position(data_.voxel_index(tile.primitive[lane], tile.offset[lane])))
              : kMiss;
    }
  }

  /// What the gain's sums are keyed by, kept for every ray as any user of the trace would.
  using VoxelNames = std::vector<std::uint64_t>;
  void keep(const detail::RayTile& tile, std::size_t number, VoxelNames& names) const {
    std::uint64_t* out = &names[number * detail::kTileRays];
    for (std::size_t lane = 0; lane < detail::kTileRays; ++lane) {
      out[lane] = static_cast<std::uint64_t>(tile.primitive[lane]) << 32U | tile.offset[lane];
    }
  }

  const oracle::DenseMap& map_;
  ScenePointer scene_;
  const VoxelScene::Data& data_;
  detail::TileTable table_;

 private:
  Pose T_grid_world_;
  float min_range_;  ///< [voxel]
  float max_range_;  ///< [voxel]
};

class ViewgainTrace final : public ViewgainKernel {
 public:
  ViewgainTrace(const TraceTask& task, ScenePointer scene)
      : ViewgainKernel("viewgain_trace", task, std::move(scene)) {}

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const detail::PoseFrame frame = frame_of(T_world_camera);
    detail::RayTile tile;
    for (std::size_t i = 0; i < table_.tile_count; ++i) {
      data_.kernels->trace(data_, table_, frame, i, tile);
      store(tile, i, endings);
    }
  }

  void run(std::span<const Pose> poses, ThreadPool& pool) override {
    pool.for_each_chunk(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
      thread_local VoxelNames names;
      names.resize(table_.tile_count * detail::kTileRays);
      detail::RayTile tile;
      for (std::size_t p = begin; p < end; ++p) {
        const detail::PoseFrame frame = frame_of(poses[p]);
        for (std::size_t i = 0; i < table_.tile_count; ++i) {
          data_.kernels->trace(data_, table_, frame, i, tile);
          keep(tile, i, names);
        }
      }
    });
  }
};

class ViewgainFloor final : public ViewgainKernel {
 public:
  ViewgainFloor(const TraceTask& task, ScenePointer scene)
      : ViewgainKernel("viewgain_floor", task, std::move(scene)), poses_(task.poses) {
    begins_.push_back(0);
    for (const Pose& pose : poses_) {
      const detail::PoseFrame frame = frame_of(pose);
      for (std::size_t i = 0; i < table_.tile_count; ++i) {
        detail::RayTile tile;
        data_.kernels->trace(data_, table_, frame, i, tile);
        add_way(tile);
      }
    }
  }

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const detail::PoseFrame frame = frame_of(T_world_camera);
    const std::size_t pose = number_of(T_world_camera);
    detail::RayTile tile;
    for (std::size_t i = 0; i < table_.tile_count; ++i) {
      data_.kernels->replay(data_, table_, frame, i, way(pose, i), tile);
      store(tile, i, endings);
    }
  }

  void run(std::span<const Pose> poses, ThreadPool& pool) override {
    pool.for_each_chunk(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
      thread_local VoxelNames names;
      names.resize(table_.tile_count * detail::kTileRays);
      detail::RayTile tile;
      for (std::size_t p = begin; p < end; ++p) {
        const detail::PoseFrame frame = frame_of(poses[p]);
        for (std::size_t i = 0; i < table_.tile_count; ++i) {
          data_.kernels->replay(data_, table_, frame, i, way(p, i), tile);
          keep(tile, i, names);
        }
      }
    });
  }

 private:
  /// Appends the distinct primitives that the tile's rays end in.
  void add_way(const detail::RayTile& tile) {
    const std::size_t begin = ways_.size();
    for (std::size_t lane = 0; lane < detail::kTileRays; ++lane) {
      if ((tile.hit >> lane & 1U) == 0) continue;
      const auto first = ways_.begin() + static_cast<std::ptrdiff_t>(begin);
      if (std::find(first, ways_.end(), tile.primitive[lane]) == ways_.end()) {
        ways_.push_back(tile.primitive[lane]);
      }
    }
    begins_.push_back(ways_.size());
  }

  [[nodiscard]] std::span<const std::uint32_t> way(std::size_t pose, std::size_t tile) const {
    const std::size_t i = pose * table_.tile_count + tile;
    return {ways_.data() + begins_[i], begins_[i + 1] - begins_[i]};
  }

  [[nodiscard]] std::size_t number_of(const Pose& pose) const {
    return static_cast<std::size_t>(std::find(poses_.begin(), poses_.end(), pose) - poses_.begin());
  }

  std::span<const Pose> poses_;
  std::vector<std::uint32_t> ways_;
  std::vector<std::size_t> begins_;
};

}  // namespace

std::unique_ptr<TraceMethod> make_viewgain_gain(const TraceTask& task, ScenePointer scene) {
  return std::make_unique<ViewgainGain>(task, std::move(scene));
}

std::unique_ptr<TraceMethod> make_viewgain_trace(const TraceTask& task, ScenePointer scene) {
  return std::make_unique<ViewgainTrace>(task, std::move(scene));
}

std::unique_ptr<TraceMethod> make_viewgain_floor(const TraceTask& task, ScenePointer scene) {
  return std::make_unique<ViewgainFloor>(task, std::move(scene));
}

}  // namespace viewgain::bench
