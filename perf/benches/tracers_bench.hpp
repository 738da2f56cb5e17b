// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace viewgain::bench {

struct TracersOptions {
  int num_threads = 1;  ///< 0: all hardware threads
  int repetitions = 9;
  std::filesystem::path mesh;  ///< of the camel
};

/// Compares Embree's BVH with the sweep, alternately. Prints a table of medians with spread.
/// Returns the exit code: 1 if a gain differs in any bit. The rows are combinations of
/// - an object, a room and a sparse hall
/// - poses around them and random poses inside
/// - batches and single poses
/// - full images, images of about 400 rays as in the first stage of a search, and of few pixels
/// - the gains paper and combined
int run_tracers(const TracersOptions& options);

}  // namespace viewgain::bench
