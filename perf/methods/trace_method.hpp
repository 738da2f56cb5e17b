// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "oracle/dense_map.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {

/// Where a ray ends: its voxel's position in the workspace's dense array, or kMiss.
using Ending = std::int32_t;
inline constexpr Ending kMiss = -1;

/// What every method is given. The sensor has no pixel that the distortion model cannot invert, its
/// cameras stand in free space outside the workspace and farther from it than min_range.
struct TraceTask {
  const BeliefGrid& grid;
  const oracle::DenseMap& map;  ///< the same states, dense
  const Sensor& sensor;
  std::span<const Pose> poses;
  int num_threads = 1;
};

/// Of a view's rays, what is not evident from a rate.
struct RayShares {
  double untraced =
      0;  ///< belong to a tile of pixels that can meet nothing, and cost next to nothing
  double embree = 0;  ///< are traced by Embree
};

/// A way to find the first voxel that is not free along every ray of a view.
/// Thread safety: const members may run from many threads.
class TraceMethod {
 public:
  TraceMethod(std::string name, std::size_t rays_per_pose)
      : name_(std::move(name)), rays_per_pose_(rays_per_pose) {}
  virtual ~TraceMethod() = default;
  TraceMethod(const TraceMethod&) = delete;
  TraceMethod& operator=(const TraceMethod&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t rays_per_pose() const { return rays_per_pose_; }

  /// The answer, in pixel order; what agreement is judged by.
  virtual void trace(const Pose& T_world_camera, std::span<Ending> endings) const = 0;

  /// What is timed: all rays of all poses, on all threads of the pool, by pose. Unless a method has
  /// its own way, trace() into a buffer of the thread.
  virtual void run(std::span<const Pose> poses, ThreadPool& pool);

  /// Over all rays of these poses.
  [[nodiscard]] virtual RayShares shares(std::span<const Pose>) const { return {}; }

 private:
  std::string name_;
  std::size_t rays_per_pose_;
};

}  // namespace viewgain::bench
