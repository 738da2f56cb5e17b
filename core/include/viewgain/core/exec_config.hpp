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

/// Settings that affect speed, never results.
struct VIEWGAIN_EXPORT ExecConfig {
  /// How to find the first non-free voxel on a ray. All tracers give bit-identical results.
  enum class Tracer : std::uint8_t {
    automatic,  ///< embree to trace many views of few rays each, otherwise sweep
    embree,     ///< a bounding volume hierarchy (BVH), which must first be built; then faster for
                ///< many views of few rays each (perf/results/tracers.md)
    sweep,      ///< visits blocks of the map from near to far, and tests which rays end in each
  };

  int num_threads = 0;  ///< number of threads, including the caller's; 0: one per hardware thread
  Tracer tracer = Tracer::automatic;  ///< used by GainEvaluator only
};

/// The number of threads for a value of ExecConfig::num_threads: that of the hardware if the value
/// is 0, otherwise the value. Throws Error(invalid_argument) if it is negative or above 1024.
[[nodiscard]] VIEWGAIN_EXPORT int thread_count(int num_threads);
/// Names of the tracers, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& tracer_names();
/// The tracer of this name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT ExecConfig::Tracer parse_tracer(std::string_view name);

/// Observes a long call, or stops it early. `stop` and `is_cancelled` have the same effect. Each
/// function documents what it returns after a stop.
struct VIEWGAIN_EXPORT BatchControl {
  std::stop_token stop{};  ///< stops the call from another thread; checked between poses
  std::function<void(std::size_t done, std::size_t total)>
      progress{};  ///< called by the call's threads, one at a time, as poses are finished
  /// Called between poses by the call's threads, one at a time. If it returns true, the call stops.
  std::function<bool()> is_cancelled{};
};

}  // namespace viewgain
