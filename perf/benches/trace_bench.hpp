// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace viewgain::bench {

struct TraceOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int voxels = 128;     ///< a side
  int poses = 200;
  int repetitions = 7;
  /// dense, openvdb, octomap: not compared with. OctoMap takes minutes and gigabytes for a tree of
  /// 512³.
  std::vector<std::string> without{};
  std::filesystem::path mesh;
  bool json = false;
};

/// Times and compares all ways to trace camel-N; prints a table or JSON. Returns the exit code: 0,
/// or 1 if an answer is wrong.
int run_trace(const TraceOptions& options);

}  // namespace viewgain::bench
