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
  std::filesystem::path
      views_file;  ///< in the layout of MA-SCVP's view_space.txt; empty: 32 of ours
  std::vector<std::string> rankers{"combined", "frontier", "random"};
  int first_views = 20;   ///< runs of each object and ranker begin at each of the first so many
  int budget = 20;        ///< views of a run
  double size = 0.15;     ///< longest side of the objects [m]
  double voxel = 0.0025;  ///< of our map [m]
  int stride = 8;         ///< of the pixels that views are scored on
  bool json = false;
};

/// Our choice of views by MA-SCVP's protocol: after each view the share of the voxels of 2 mm seen
/// so far, of those that all views of a hemisphere see. Returns the exit code, 0.
int run_hemisphere(const HemisphereOptions& options);

}  // namespace viewgain::bench
