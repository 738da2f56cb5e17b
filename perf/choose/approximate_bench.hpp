// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace viewgain::bench {

struct ApproximateOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int voxels = 128;     ///< a side
  int poses = 1000;
  int repetitions = 7;
  std::filesystem::path mesh;
  bool json = false;
};

/// Accuracy against speed of views that are not scored in full, by pixel stride and by
/// approximate(): rank correlation with the full gains and speed as a multiple of scoring in full,
/// all ways in turns. Prints a table or JSON. Returns the exit code, 0.
int run_approximate(const ApproximateOptions& options);

}  // namespace viewgain::bench
