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
    automatic,  ///< embree for scenes that get many views of few rays each, otherwise sweep
    embree,     ///< a bounding volume hierarchy (BVH): once built, faster for such views
                ///< (perf/results/tracers.md)
    sweep,      ///< visits cells of the map from near to far, and tests which rays end in each
  };

  int num_threads = 0;  ///< number of threads, including the caller's; 0: all of the hardware
  Tracer tracer = Tracer::automatic;  ///< used by GainEvaluator only
};

/// The number of threads that ExecConfig::num_threads stands for: all hardware threads if it is 0.
/// Throws Error(invalid_argument) if it is negative or above 1024.
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
      progress{};  ///< called from any of the call's threads, by one at a time
  /// Called between poses from any of the call's threads, by one at a time; true stops the call.
  std::function<bool()> is_cancelled{};
};

}  // namespace viewgain
