// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace viewgain::bench {

struct TracersOptions {
  int num_threads = 1;  ///< 0: all hardware threads
  int repetitions = 9;
  std::filesystem::path mesh;  ///< the camel's
};

/// Embree's BVH against the sweep, side by side: an object, a room and a sparse hall; poses round
/// them and at random inside; batches and single poses; full images, those of about 400 rays as in
/// a search's first stage, and of few pixels; by the paper's and by the combined gain. Prints a
/// table of medians with spread. Returns the exit code: 1 if a gain differs by a bit.
int run_tracers(const TracersOptions& options);

}  // namespace viewgain::bench
