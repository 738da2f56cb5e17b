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

/// The end of a ray: the position of its voxel in the dense array of the workspace, or kMiss.
using Ending = std::int32_t;
inline constexpr Ending kMiss = -1;

/// The input of every method. The distortion model can invert all pixels of the sensor. Cameras are
/// in free space outside the workspace, and farther from it than min_range.
struct TraceTask {
  const BeliefGrid& grid;
  const oracle::DenseMap& map;  ///< the same states, dense
  const Sensor& sensor;
  std::span<const Pose> poses;
  int num_threads = 1;
};

/// Shares of rays that a rate does not show.
struct RayShares {
  double untraced = 0;  ///< in tiles of pixels that can meet nothing, and cost next to nothing
  double embree = 0;    ///< traced by Embree
};

/// A method to find the first voxel that is not free along every ray of a view.
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

  /// The answers in pixel order, for comparison with the oracle.
  virtual void trace(const Pose& T_world_camera, std::span<Ending> endings) const = 0;

  /// The timed part: all rays of all poses, on all threads of the pool, by pose. The default calls
  /// trace() with a buffer per thread.
  virtual void run(std::span<const Pose> poses, ThreadPool& pool);

  /// Shares over all rays of these poses.
  [[nodiscard]] virtual RayShares shares(std::span<const Pose>) const { return {}; }

 private:
  std::string name_;
  std::size_t rays_per_pose_;
};

}  // namespace viewgain::bench
