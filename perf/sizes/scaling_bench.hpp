// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace viewgain::bench {

struct ScalingOptions {
  int num_threads = 0;                         ///< the most; 0: all hardware threads
  std::vector<int> voxels{64, 128, 256, 512};  ///< a side
  int poses = 100;                             ///< at full resolution
  int repetitions = 7;
  std::filesystem::path mesh;
  bool json = false;
};

/// The full gain end to end: maps × rays a pose × threads, in turns; and the memory of each map and
/// scene. Prints a table or JSON. Returns the exit code: 0, or 1 if an answer is wrong or depends
/// on the number of threads.
int run_scaling(const ScalingOptions& options);

}  // namespace viewgain::bench
