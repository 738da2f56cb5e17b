// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain::bench {

struct ArmadilloOptions {
  int num_threads = 0;         ///< 0: all hardware threads
  std::filesystem::path data;  ///< clone of NBV-Simulation, or a stand-in
  std::vector<std::string> rankers{"combined", "surface", "paper", "frontier"};
  std::vector<double> travel{0.0, 0.5};  ///< weights of the distance in the score
  int views = 10;
  double voxel = 0.0025;  ///< voxel size of our map [m]
  int stride = 16;        ///< views are scored on every stride-th pixel and row
  bool json = false;
};

/// Compares our choice of views, by NBV-Simulation's protocol, with the log that it ships. After
/// each view, the results have the share of voxels that its OctoMap counts, and the share of points
/// with a reading near by. Returns the exit code, 0.
int run_armadillo(const ArmadilloOptions& options);

}  // namespace viewgain::bench
