// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "gain_accumulator.hpp"
#include "scene_data.hpp"
#include "view_tracer.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

struct GainEvaluator::Impl {
  std::shared_ptr<const VoxelScene> scene;
  const VoxelScene::Data& data;
  detail::GainSettings settings;
  double prior_sigma = 0;  // [m]
  detail::ViewTracer tracer;
  std::uint32_t ray_count = 0;
  mutable ThreadPool pool;

  // What a thread needs to score a pose.
  struct Workspace {
    detail::GainAccumulator accumulator;
    detail::TileBins bins;
  };
  // Those that no thread is using, so that a call need not make one.
  mutable std::mutex idle_mutex;
  mutable std::vector<std::unique_ptr<Workspace>> idle;

  Impl(std::shared_ptr<const VoxelScene> s, const Sensor& sensor, const GainConfig& config,
       const ExecConfig& exec);

  // A workspace for as long as the lease lives.
  class Lease {
   public:
    explicit Lease(const Impl& impl) : impl_(impl) {
      const std::lock_guard lock(impl.idle_mutex);
      if (!impl.idle.empty()) {
        workspace_ = std::move(impl.idle.back());
        impl.idle.pop_back();
      }
    }
    ~Lease() {
      if (!workspace_) return;
      const std::lock_guard lock(impl_.idle_mutex);
      impl_.idle.push_back(std::move(workspace_));
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    Workspace& get() {
      if (!workspace_) {
        workspace_ = std::make_unique<Workspace>(Workspace{
            detail::GainAccumulator(impl_.data, impl_.settings, impl_.tracer.table().ray_count()),
            {}});
      }
      return *workspace_;
    }

   private:
    const Impl& impl_;
    std::unique_ptr<Workspace> workspace_;
  };

  [[nodiscard]] bool is_in_occupied(const detail::PoseFrame& frame) const;
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera, Lease& lease) const;
};

}  // namespace viewgain
