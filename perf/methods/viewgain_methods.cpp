// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain_methods.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <vector>

#include "hit_boxes.hpp"
#include "scene/scene_data.hpp"
#include "trace/view_tracer.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

/// Traces alone.
class ViewgainTrace : public TraceMethod {
 public:
  ViewgainTrace(std::string name, const TraceTask& task, ScenePointer scene,
                ExecConfig::Tracer tracer)
      : TraceMethod(std::move(name), task.sensor.camera.ray_table().size()),
        map_(task.map),
        scene_(std::move(scene)),
        data_(detail::SceneAccess::data(*scene_)),
        tracer_(data_, std::make_shared<const detail::SensorRays>(task.sensor.camera, 1),
                task.sensor.min_range, task.sensor.max_range, tracer),
        way_(tracer) {}

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    std::fill(endings.begin(), endings.end(), kMiss);
    for_each_tile(T_world_camera, [&](std::size_t number, const detail::RayTile& tile) {
      for (int lane = 0; lane < detail::kTileRays; ++lane) {
        if ((tile.hit >> lane & 1U) == 0) continue;
        endings[tracer_.table().ray_index(number, lane)] = static_cast<Ending>(
            map_.position(data_.voxel_index(tile.primitive[lane], tile.offset[lane])));
      }
    });
  }

  /// Each tile's endings stay in its RayTile, which is where the gain takes them from.
  void run(std::span<const Pose> poses, ThreadPool& pool) override {
    pool.for_each_chunk(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (const Pose& pose : poses.subspan(begin, end - begin)) {
        for_each_tile(pose, [](std::size_t, const detail::RayTile&) {});
      }
    });
  }

  [[nodiscard]] RayShares shares(std::span<const Pose> poses) const override {
    std::size_t traced = 0;
    for (const Pose& pose : poses) {
      for_each_tile(pose, [&](std::size_t, const detail::RayTile& tile) {
        traced += static_cast<std::size_t>(std::popcount(tile.valid));
      });
    }
    const auto all = static_cast<double>(poses.size() * rays_per_pose());
    return {1 - static_cast<double>(traced) / all, way_ == ExecConfig::Tracer::embree ? 1.0 : 0.0};
  }

 protected:
  using Visit = std::function<void(std::size_t, const detail::RayTile&)>;

  /// The tiles that may have hit something.
  virtual void for_each_tile(const Pose& T_world_camera, const Visit& visit) const {
    const detail::PoseFrame frame = frame_of(T_world_camera);
    thread_local detail::ViewSweep sweep;
    tracer_.prepare(frame, sweep);
    tracer_.trace(frame, sweep, visit);
  }

  [[nodiscard]] detail::PoseFrame frame_of(const Pose& T_world_camera) const {
    return tracer_.frame_of(T_world_camera).value();
  }

  const oracle::DenseMap& map_;
  ScenePointer scene_;
  const detail::SceneData& data_;
  detail::ViewTracer tracer_;

 private:
  ExecConfig::Tracer way_;
};

/// The same kernel on the leaves that each tile is known to end in.
class ViewgainFloor final : public ViewgainTrace {
 public:
  ViewgainFloor(const TraceTask& task, ScenePointer scene)
      : ViewgainTrace("viewgain_floor", task, std::move(scene), ExecConfig::Tracer::sweep),
        poses_(task.poses) {
    const std::size_t tiles = tracer_.table().tile_count;
    begins_.assign(poses_.size() * tiles + 1, 0);
    detail::ViewSweep sweep;
    for (std::size_t p = 0; p < poses_.size(); ++p) {
      const detail::PoseFrame frame = frame_of(poses_[p]);
      tracer_.prepare(frame, sweep);
      tracer_.trace(frame, sweep, [&](std::size_t tile, const detail::RayTile& out) {
        const std::vector<std::uint32_t> way = hit_boxes(out);
        ways_.insert(ways_.end(), way.begin(), way.end());
        begins_[p * tiles + tile + 1] = ways_.size();
      });
    }
    // Tiles that meet nothing have none.
    for (std::size_t i = 1; i < begins_.size(); ++i) {
      begins_[i] = std::max(begins_[i], begins_[i - 1]);
    }
  }

 protected:
  void for_each_tile(const Pose& T_world_camera, const Visit& visit) const override {
    const auto pose = std::find(poses_.begin(), poses_.end(), T_world_camera) - poses_.begin();
    const detail::PoseFrame frame = frame_of(T_world_camera);
    const std::size_t tiles = tracer_.table().tile_count;
    detail::RayTile out;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
      const std::size_t i = static_cast<std::size_t>(pose) * tiles + tile;
      if (begins_[i] == begins_[i + 1]) continue;  // known to miss everything
      data_.tracing->kernels.begin(tracer_.table(), frame, tile, out);
      for (std::size_t k = begins_[i]; k < begins_[i + 1]; ++k) {
        data_.tracing->kernels.visit(data_, frame, ways_[k], out);
      }
      visit(tile, out);
    }
  }

 private:
  std::span<const Pose> poses_;
  std::vector<std::uint32_t> ways_;
  std::vector<std::size_t> begins_;
};

/// A gain of each pose.
class ViewgainGain final : public TraceMethod {
 public:
  ViewgainGain(std::string name, const TraceTask& task, const ScenePointer& scene, GainModel model,
               ExecConfig::Tracer tracer)
      : TraceMethod(std::move(name), task.sensor.camera.ray_table().size()),
        map_(task.map),
        model_(model),
        evaluator_(scene, task.sensor, {.model = model},
                   {.num_threads = task.num_threads, .tracer = tracer}),
        tracing_("", task, scene, tracer) {}

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const std::vector<RayHit> hits = evaluator_.trace(T_world_camera);
    const auto ends = std::count_if(
        hits.begin(), hits.end(), [](const RayHit& hit) { return hit.kind != RayHit::Kind::none; });
    const ViewGain gain = evaluator_.evaluate(T_world_camera);
    if (model_ == GainModel::paper && gain.hits != ends) {
      throw std::runtime_error(
          "the gain was computed from other hits than those that trace() returns");
    }
    std::transform(hits.begin(), hits.end(), endings.begin(), [&](const RayHit& hit) {
      return hit.kind == RayHit::Kind::none ? kMiss : static_cast<Ending>(map_.position(hit.voxel));
    });
  }

  /// On the evaluator's own threads, as many as the pool has.
  void run(std::span<const Pose> poses, ThreadPool&) override {
    results_.resize(poses.size());
    evaluator_.evaluate(poses, results_);
  }

  [[nodiscard]] RayShares shares(std::span<const Pose> poses) const override {
    return tracing_.shares(poses);
  }

 private:
  const oracle::DenseMap& map_;
  GainModel model_;
  GainEvaluator evaluator_;
  ViewgainTrace tracing_;
  std::vector<ViewGain> results_;
};

}  // namespace

std::vector<std::unique_ptr<TraceMethod>> make_viewgain_gains(const TraceTask& task,
                                                              const ScenePointer& scene) {
  std::vector<std::unique_ptr<TraceMethod>> methods;
  for (const ExecConfig::Tracer tracer : {ExecConfig::Tracer::sweep, ExecConfig::Tracer::embree}) {
    const std::string by = tracer == ExecConfig::Tracer::embree ? "_embree" : "";
    for (const auto& [name, model] : {std::pair("viewgain_gain", GainModel::paper),
                                      std::pair("viewgain_surface", GainModel::surface),
                                      std::pair("viewgain_combined", GainModel::combined)}) {
      methods.push_back(std::make_unique<ViewgainGain>(name + by, task, scene, model, tracer));
    }
  }
  return methods;
}

std::unique_ptr<TraceMethod> make_viewgain_trace(const TraceTask& task, ScenePointer scene) {
  return std::make_unique<ViewgainTrace>("viewgain_trace", task, std::move(scene),
                                         ExecConfig::Tracer::sweep);
}

std::unique_ptr<TraceMethod> make_viewgain_trace_embree(const TraceTask& task, ScenePointer scene) {
  return std::make_unique<ViewgainTrace>("viewgain_trace_embree", task, std::move(scene),
                                         ExecConfig::Tracer::embree);
}

std::unique_ptr<TraceMethod> make_viewgain_floor(const TraceTask& task, ScenePointer scene) {
  return std::make_unique<ViewgainFloor>(task, std::move(scene));
}

}  // namespace viewgain::bench
