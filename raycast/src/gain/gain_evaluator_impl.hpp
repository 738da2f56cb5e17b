// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "view_driver.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {

namespace detail {

/// What a lane ends in, which must be one that is hit or blocked.
[[nodiscard]] inline RayHit::Kind kind_of_end(const SceneData& scene, const RayTile& tile,
                                              int lane) {
  if ((tile.blocked >> lane & 1U) != 0) return RayHit::Kind::obstacle;
  return scene.occupied_leaf(tile.primitive[lane], tile.offset[lane]) != nullptr
             ? RayHit::Kind::occupied
             : RayHit::Kind::unknown;
}

/// As ViewDriver::evaluate(), the same bits, with all threads at one view.
[[nodiscard]] ViewGain evaluate_together(const ViewDriver& driver, const Pose& T_world_camera);

/// What a measure of the user's own says of a view: NaN for a bad pose, 0 for a camera in an
/// occupied voxel, of which it is not asked. Throws what the measure throws.
[[nodiscard]] double measured(const ViewDriver& driver, const Pose& T_world_camera,
                              ViewDriver::Lease& lease, const ViewMeasure& measure);
[[nodiscard]] double measured(const ViewDriver& driver, const Pose& T_world_camera,
                              ViewDriver::Lease& lease, const RunMeasure& measure);

}  // namespace detail

struct GainEvaluator::Impl {
  std::shared_ptr<const VoxelScene> scene;
  detail::ViewDriver driver;

  Impl(std::shared_ptr<const VoxelScene> s, std::shared_ptr<detail::EvaluatorCore> core)
      : scene(std::move(s)), driver(*scene, std::move(core)) {}
};

namespace detail {

/// The way into an evaluator for this module.
struct EvaluatorAccess {
  [[nodiscard]] static const ViewDriver& driver(const GainEvaluator& evaluator) {
    return evaluator.impl_->driver;
  }
};

/// Throws Error(invalid_argument) if there is not one result for each pose.
inline void check_room(std::size_t poses, std::size_t results) {
  if (poses == results) return;
  refuse("there are " + std::to_string(poses) + " poses, but the array has room for " +
         std::to_string(results) + " results");
}

/// Calls work(i, lease) for every i below count on all threads; ends early if a stop is requested
/// or the call cancelled. Returns whether all was done. A driver has a core() with a pool, and a
/// Lease of what a thread works in.
template <typename Driver, typename Work>
bool for_each(const Driver& driver, std::size_t count, const BatchControl& control,
              const Work& work) {
  ThreadPool& pool = driver.core()->pool;
  std::atomic<bool> complete{true};
  std::mutex cancel_mutex;
  const auto is_stopped = [&] {
    if (!complete || control.stop.stop_requested()) return true;
    if (!control.is_cancelled) return false;
    const std::lock_guard lock(cancel_mutex);
    if (complete && control.is_cancelled()) complete = false;
    return !complete;
  };
  // Some chunks for each thread, so that none is left with much more than the others.
  const std::size_t shares = 8 * static_cast<std::size_t>(pool.num_threads());
  const std::size_t chunk = std::clamp<std::size_t>(count / shares, 1, 4);
  pool.for_each_chunk(count, chunk, [&](std::size_t begin, std::size_t end) {
    typename Driver::Lease lease(driver);
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

/// The same for whole scores: says how many are done, and returns that.
template <typename Driver, typename Work>
std::size_t for_each_pose(const Driver& driver, std::size_t count, const BatchControl& control,
                          const Work& work) {
  std::atomic<std::size_t> done{0};
  std::mutex progress_mutex;
  std::size_t reported = 0;
  for_each(driver, count, control, [&](std::size_t i, typename Driver::Lease& lease) {
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

}  // namespace detail

}  // namespace viewgain
