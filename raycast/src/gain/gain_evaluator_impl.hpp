// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "gain_accumulator.hpp"
#include "scene/scene_data.hpp"
#include "trace/view_tracer.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::detail {

[[nodiscard]] inline SymmetricMatrix3 matrix_of(const VoxelSum& m) {
  return {m.a[0], m.a[1], m.a[2], m.a[3], m.b[0], m.b[1]};
}

}  // namespace viewgain::detail

namespace viewgain {

struct GainEvaluator::Impl {
  std::shared_ptr<const VoxelScene> scene;
  const VoxelScene::Data& data;
  detail::GainSettings settings;
  double prior_sigma = 0;               // [m]
  double min_range = 0, max_range = 0;  // along the ray [m]
  detail::ViewTracer tracer;
  PinholeCamera camera;
  int pixel_stride = 1;
  std::uint32_t ray_count = 0;
  const detail::GainKernels* kernels = nullptr;
  mutable ThreadPool pool;

  // What a thread needs to score a pose.
  struct Workspace {
    detail::GainAccumulator accumulator;
    detail::TileBins bins;
    std::vector<ViewHit> view_hits{};  // for a gain of the user's own
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
      try {
        impl_.idle.push_back(std::move(workspace_));
      } catch (const std::bad_alloc&) {  // then the next call makes one
      }
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    Workspace& get() {
      if (!workspace_) {
        workspace_ = std::make_unique<Workspace>(Workspace{
            detail::GainAccumulator(impl_.data, impl_.settings, impl_.tracer.table().ray_count()),
            {},
            {}});
      }
      return *workspace_;
    }

   private:
    const Impl& impl_;
    std::unique_ptr<Workspace> workspace_;
  };

  [[nodiscard]] bool is_in_occupied(const detail::PoseFrame& frame) const;
  // The pose in the scene; nothing if there is nothing to trace, which `result` then says.
  [[nodiscard]] std::optional<detail::PoseFrame> open_view(const Pose& T_world_camera,
                                                           ViewGain& result) const;
  [[nodiscard]] ViewGain evaluate(const Pose& T_world_camera, Lease& lease) const;
  // A gain of the user's own; throws what it throws.
  [[nodiscard]] double measure(const Pose& T_world_camera, const ViewMeasure& own,
                               Lease& lease) const;

  // A view's tiles in groups, which any thread may trace; their hits are added up in order.
  struct TileGroups {
    explicit TileGroups(std::size_t count) : hits(count), is_traced(count) {}
    std::vector<detail::HitList> hits;
    std::vector<std::atomic<bool>> is_traced;
    std::atomic<std::size_t> next{0};  // to be traced
  };
  mutable std::vector<std::unique_ptr<TileGroups>> idle_groups;
  // As evaluate(), the same bits, on all threads (one_view.cpp).
  [[nodiscard]] ViewGain evaluate_together(const Pose& T_world_camera) const;
  // Calls work(i, lease) for every i below count on all threads; ends early if a stop is requested
  // or the call cancelled. Returns whether all was done.
  template <typename Work>
  bool for_each(std::size_t count, std::size_t chunk, const BatchControl& control,
                const Work& work) const {
    std::atomic<bool> complete{true};
    std::mutex cancel_mutex;
    const auto is_stopped = [&] {
      if (!complete || control.stop.stop_requested()) return true;
      if (!control.is_cancelled) return false;
      const std::lock_guard lock(cancel_mutex);
      if (complete && control.is_cancelled()) complete = false;
      return !complete;
    };
    pool.for_each_chunk(count, chunk, [&](std::size_t begin, std::size_t end) {
      Lease lease(*this);
      for (std::size_t i = begin; i < end; ++i) {
        if (is_stopped()) {
          complete = false;
          return;
        }
        work(i, lease);
      }
    });
    return complete;
  }

  // The same for whole scores: says how many are done, and returns that.
  template <typename Work>
  std::size_t for_each_pose(std::size_t count, const BatchControl& control,
                            const Work& work) const {
    std::atomic<std::size_t> done{0};
    std::mutex progress_mutex;
    std::size_t reported = 0;
    for_each(count, 4, control, [&](std::size_t i, Lease& lease) {
      work(i, lease);
      const std::size_t now = done.fetch_add(1) + 1;
      if (!control.progress) return;
      const std::lock_guard lock(progress_mutex);
      if (now <= reported) return;  // another thread has already said more
      reported = now;
      control.progress(now, count);
    });
    return done;
  }

  // Traces groups of a pose's tiles and adds up what each gains by itself, into gains, one a group;
  // NaN for a bad pose.
  void sample(const Pose& T_world_camera, std::span<const std::vector<std::uint32_t>> groups,
              std::span<double> gains, Lease& lease) const;
  // The first tiles of a random sequence that covers the image evenly from the start, dealt out in
  // turns, so that all groups together are spread more evenly than each.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> random_tiles(std::size_t groups,
                                                                     std::size_t per_group,
                                                                     std::uint64_t seed) const;
  // Rays of a group.
  [[nodiscard]] std::uint64_t rays_of(std::span<const std::uint32_t> tiles) const;
  // The gain of a pose after others have been chosen, by what their rays bring to each voxel.
  [[nodiscard]] ViewGain evaluate_after(
      const Pose& T_world_camera, const std::unordered_map<std::uint64_t, SymmetricMatrix3>& chosen,
      Lease& lease) const;
  // The full scores of some of the poses, in their order; entries not reached stay as they are.
  bool evaluate_some(std::span<const Pose> T_world_camera, std::span<const std::size_t> indices,
                     std::span<ViewGain> results, const BatchControl& control) const;
};

}  // namespace viewgain
