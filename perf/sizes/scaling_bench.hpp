// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace viewgain::bench {

struct ScalingOptions {
  int num_threads = 0;                         ///< maximum; 0: all hardware threads
  std::vector<int> voxels{64, 128, 256, 512};  ///< per side
  int poses = 100;                             ///< number of views at full resolution
  int repetitions = 7;
  std::filesystem::path mesh;
  bool json = false;
};

/// Times the full gain for each combination of map, rays per pose and threads, alternately. Also
/// reports the memory of each map and scene. Prints a table or JSON. Returns the exit code: 1 if an
/// answer is wrong or depends on the number of threads.
int run_scaling(const ScalingOptions& options);

}  // namespace viewgain::bench
