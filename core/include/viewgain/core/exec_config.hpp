// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// What changes only speed, never an answer.
struct VIEWGAIN_EXPORT ExecConfig {
  /// How a view's rays find the first voxel that is not free. Results are the same bits.
  enum class Tracer : std::uint8_t {
    automatic,  ///< the sweep: full images are faster by it, and there is no BVH to make
    embree,  ///< a BVH of leaves and boxes: for few rays and many views (perf/results/tracers.md)
    sweep,   ///< the scene's cells from near to far, each over the rays that it can end
  };

  int num_threads = 0;  ///< 0: all hardware threads; 1: the caller alone; n: caller and n - 1 more
  Tracer tracer = Tracer::automatic;  ///< of gain evaluators; others do not trace voxels
};

/// The number of threads that ExecConfig::num_threads stands for: all hardware threads if 0. Throws
/// Error(invalid_argument) if it is negative or over 1024.
[[nodiscard]] VIEWGAIN_EXPORT int thread_count(int num_threads);
/// Names of the tracers, in their order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& tracer_names();
/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] VIEWGAIN_EXPORT ExecConfig::Tracer parse_tracer(std::string_view name);

/// Watches one long call, or ends it early: two ways to do so with one effect, see the call.
struct VIEWGAIN_EXPORT BatchControl {
  std::stop_token stop{};  ///< for ending it from another thread; looked at between poses
  std::function<void(std::size_t done, std::size_t total)>
      progress{};  ///< from any worker, one at a time
  /// For a caller that is to be asked: between poses, by any worker, one at a time; true ends it.
  std::function<bool()> is_cancelled{};
};

}  // namespace viewgain
