// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "evaluator_core.hpp"
#include "scene/scene_data.hpp"
#include "surface_view.hpp"
#include "trace/view_tracer.hpp"

namespace viewgain::detail {

/// The way from a pose to what becomes of its hits: open the view, trace its tiles, hand them to a
/// consumer, finish. For the evaluator of one scene. Thread safe.
class ViewDriver {
 public:
  /// The scene must outlive it.
  ViewDriver(const VoxelScene& scene, std::shared_ptr<EvaluatorCore> core);
  ViewDriver(const ViewDriver&) = delete;
  ViewDriver& operator=(const ViewDriver&) = delete;

  /// A workspace for as long as the lease lives.
  class Lease {
   public:
    explicit Lease(const ViewDriver& driver)
        : driver_(driver), workspace_(driver.core_->workspaces.take()) {}
    ~Lease() {
      if (workspace_) driver_.core_->workspaces.give_back(std::move(workspace_));
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    [[nodiscard]] Workspace& workspace() {
      if (!workspace_) workspace_ = std::make_unique<Workspace>();
      return *workspace_;
    }
    /// Sums for the driver's scene.
    [[nodiscard]] GainAccumulator& accumulator() {
      Workspace& own = workspace();
      if (own.bound_to != driver_.number_) driver_.bind(own);
      return *own.accumulator;
    }

   private:
    const ViewDriver& driver_;
    std::unique_ptr<Workspace> workspace_;
  };

  /// From where views are traced: a camera in an occupied voxel gains nothing, but sees from there.
  enum class From : std::uint8_t { outside_occupied, anywhere };

  /// The pose in the scene; nothing if there is nothing to trace, which `result` then says.
  [[nodiscard]] std::optional<PoseFrame> open(const Pose& T_world_camera, ViewGain& result,
                                              From from = From::outside_occupied) const;

  /// Traces all tiles of a view into a consumer: begin(); add(tile number, RayTile) for those that
  /// can meet anything; finish(ViewGain&). What the consumer throws goes through.
  template <ViewTracer::Asked kAsked = ViewTracer::Asked::before_voxels, typename Consumer>
  ViewGain view(const Pose& T_world_camera, Lease& lease, Consumer&& consumer,
                From from = From::outside_occupied) const {
    ViewGain result;
    const auto frame = open(T_world_camera, result, from);
    if (!frame) return result;
    ViewSweep& sweep = lease.workspace().sweep;
    tracer_.prepare(*frame, sweep, kAsked);
    consumer.begin();
    tracer_.trace<kAsked>(*frame, sweep, [&](std::size_t number, const RayTile& tile) {
      consumer.add(number, tile);
    });
    consumer.finish(result);
    result.status = ViewGain::Status::ok;
    return result;
  }

  /// A view's gain; the accumulator keeps the sums until its next view.
  /// `missed`: as SurfaceView::evaluate() has it.
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera, Lease& lease,
                                  const float* missed = nullptr) const;

  [[nodiscard]] const SceneData& scene() const { return scene_; }
  [[nodiscard]] const std::shared_ptr<EvaluatorCore>& core() const { return core_; }
  [[nodiscard]] const GainSettings& settings() const { return settings_; }
  [[nodiscard]] const ViewTracer& tracer() const { return tracer_; }
  [[nodiscard]] double prior_sigma() const { return prior_sigma_; }
  /// Null for the paper's gain.
  [[nodiscard]] const SurfaceView* surface() const {
    return core_->config.model != GainModel::paper ? &ordered() : nullptr;
  }
  /// Whether threads may share one view: not if task weights are given to all shares of its rays.
  [[nodiscard]] bool may_share_views() const {
    return surface() == nullptr || core_->config.weights.empty();
  }
  /// Rays in order through unknown voxels, whatever the gain; made when first asked for. Thread
  /// safe. Throws as SurfaceView's constructor.
  [[nodiscard]] const SurfaceView& ordered() const;

 private:
  void bind(Workspace& workspace) const;
  [[nodiscard]] bool is_in_occupied(const PoseFrame& frame) const;

  const SceneData& scene_;
  std::shared_ptr<EvaluatorCore> core_;
  double prior_sigma_;  // [m]
  GainSettings settings_;
  ViewTracer tracer_;
  mutable std::once_flag surface_once_;
  mutable std::optional<SurfaceView> surface_;
  std::uint64_t number_;  // among the core's, from 1 on
};

/// A consumer that sums the hits of a view by voxel and fills in its gain.
struct GainConsumer {
  GainAccumulator& accumulator;

  void begin() { accumulator.begin(); }
  void add(std::size_t, const RayTile& tile) { accumulator.add(tile); }
  void finish(ViewGain& result) { accumulator.finish(result); }
};

/// Calls visit(lane) for the lanes whose bits are set, in order.
template <typename Visit>
void for_each_lane(std::uint32_t lanes, Visit&& visit) {
  for (; lanes != 0; lanes &= lanes - 1) visit(std::countr_zero(lanes));
}

}  // namespace viewgain::detail
