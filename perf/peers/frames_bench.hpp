// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace viewgain::bench {

struct FramesOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  std::vector<std::filesystem::path> meshes;
  std::vector<double> degrees{0, 15, 30, 45};  ///< that the grid is turned by
  int seeds = 2;                               ///< 1 .. seeds, of start and noise
  int views = 12;                              ///< budget of a run
  int candidates = 200;                        ///< on the sphere
  double voxel = 0.003125;                     ///< [m]
  bool json = false;
};

/// What the paper's criterion, log_diagonal, costs for being taken in the grid's axes: on grids
/// that are turned about z and about (1, 1, 1), how alike it ranks candidates to log_determinant,
/// which no turn changes, how much of that one's best gain its favourite gives away, and how many
/// views more a run by it takes to 90 %. Returns the exit code, 0.
int run_frames(const FramesOptions& options);

}  // namespace viewgain::bench
