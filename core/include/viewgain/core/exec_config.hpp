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
  /// How to find the first voxel on a ray that is not free. All tracers give bit-identical results.
  enum class Tracer : std::uint8_t {
    automatic,  ///< the sweep, or embree for scenes that get many views of few rays each
    embree,     ///< a BVH: faster for such views once it is built (perf/results/tracers.md)
    sweep,  ///< visits cells from near to far and tests each against the rays that can end in it
  };

  int num_threads = 0;                ///< including the calling thread; 0: all hardware threads
  Tracer tracer = Tracer::automatic;  ///< of gain evaluators; other classes trace no voxels
};

/// Number of threads for ExecConfig::num_threads: all hardware threads if it is 0. Throws
/// Error(invalid_argument) if it is negative or above 1024.
[[nodiscard]] VIEWGAIN_EXPORT int thread_count(int num_threads);
/// Names of the tracers, in enumeration order.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& tracer_names();
/// Parses a name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT ExecConfig::Tracer parse_tracer(std::string_view name);

/// Observes one long call or stops it early. `stop` and `is_cancelled` have the same effect; each
/// call documents what it then returns.
struct VIEWGAIN_EXPORT BatchControl {
  std::stop_token stop{};  ///< stops the call from another thread; checked between poses
  std::function<void(std::size_t done, std::size_t total)>
      progress{};  ///< called by any worker, one at a time
  /// Called between poses by any worker, one at a time; true stops the call.
  std::function<bool()> is_cancelled{};
};

}  // namespace viewgain
