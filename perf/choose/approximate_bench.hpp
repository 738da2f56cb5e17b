// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace viewgain::bench {

struct ApproximateOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int voxels = 128;     ///< per side
  int poses = 1000;
  int repetitions = 7;
  std::filesystem::path mesh;
  bool json = false;
};

/// Measures accuracy and speed of pixel strides and of approximate(), alternately. Accuracy is the
/// rank correlation with the full gains. Speed is relative to scoring in full. Prints a table or
/// JSON. Returns the exit code, 0.
int run_approximate(const ApproximateOptions& options);

}  // namespace viewgain::bench
