// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace viewgain::bench {

struct FramesOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  std::vector<std::filesystem::path> meshes;
  std::vector<double> degrees{0, 15, 30, 45};  ///< rotations of the grid
  int seeds = 2;                               ///< seeds 1 to this, for start and noise
  int views = 12;                              ///< budget per run
  int candidates = 200;                        ///< on the sphere
  double voxel = 0.003125;                     ///< [m]
  bool json = false;
};

/// Measures how much the paper's criterion log_diagonal depends on the axes of the grid. Grids are
/// turned about z and (1, 1, 1). log_determinant does not depend on the axes and is the reference.
/// Results are the rank correlation of candidates, the share of the best gain that is given away,
/// and the number of views to 90 %. Returns the exit code, 0.
int run_frames(const FramesOptions& options);

}  // namespace viewgain::bench
