// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain::bench {

struct TraceOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int voxels = 128;     ///< per side
  int poses = 200;
  int repetitions = 7;
  /// Methods to skip: dense, tree64, openvdb, octomap. OctoMap takes minutes and gigabytes for a
  /// tree of 512³.
  std::vector<std::string> without{};
  std::filesystem::path mesh;
  bool json = false;
};

/// Times and compares all methods on camel-N. Prints a table or JSON. Returns the exit code: 1 if
/// an answer of viewgain is wrong.
int run_trace(const TraceOptions& options);

}  // namespace viewgain::bench
