// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace viewgain::bench {

struct IterationOptions {
  int num_threads = 2;
  int voxels = 128;  ///< a side of the 0.4 m workspace
  int repetitions = 7;
  int candidates = 500;
  std::filesystem::path mesh;
  bool json = false;
};

/// One turn of the loop after eight views, by stage. Returns the exit code.
int run_iteration(const IterationOptions& options);

}  // namespace viewgain::bench
