// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain::bench {

struct HemisphereOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path views_file;  ///< like MA-SCVP's view_space.txt; empty: 32 of ours
  std::vector<std::string> rankers{"combined", "frontier", "random"};
  int first_views = 20;   ///< number of first views; each starts a run per object and ranker
  int budget = 20;        ///< views per run
  double size = 0.15;     ///< longest side of the objects [m]
  double voxel = 0.0025;  ///< voxel size of our map [m]
  int stride = 8;         ///< views are scored on every stride-th pixel and row
  bool json = false;
};

/// Measures our choice of views by MA-SCVP's protocol. After each view, coverage is the share of
/// voxels of 2 mm seen so far, among those that all views of the hemisphere see. Returns the exit
/// code, 0.
int run_hemisphere(const HemisphereOptions& options);

}  // namespace viewgain::bench
