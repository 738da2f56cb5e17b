// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain::bench {

struct ArmadilloOptions {
  int num_threads = 0;         ///< 0: all hardware threads
  std::filesystem::path data;  ///< a clone of NBV-Simulation, or a stand-in
  std::vector<std::string> rankers{"combined", "surface", "paper", "frontier"};
  std::vector<double> travel{0.0, 0.5};  ///< share of the way in the score
  int views = 10;
  double voxel = 0.0025;  ///< of our map [m]
  int stride = 16;        ///< of the pixels that views are scored on
  bool json = false;
};

/// Our choice of views by NBV-Simulation's protocol, against its shipped log: after each view the
/// share of the voxels that its OctoMap counts, and the share of the points that have a reading
/// near by. Returns the exit code, 0.
int run_armadillo(const ArmadilloOptions& options);

}  // namespace viewgain::bench
