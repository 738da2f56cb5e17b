// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace viewgain::bench {

struct DecisionOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  int repetitions = 5;
  /// Of camel-N (N voxels a side of the 0.4 m workspace, eight views before), room (a recording),
  /// hall (of kHallWorkspace, 5 cm voxels, 60 frames).
  std::vector<std::string> maps{"camel-128", "camel-512", "hall"};
  std::vector<std::size_t> candidates{100, 500, 2000};
  std::filesystem::path mesh;       ///< the camel's
  std::filesystem::path recording;  ///< of the room: a folder that open_frames() reads
  double room_voxel = 0.02;         ///< [m]
  bool json = false;
};

/// What a user waits for: a frame comes in, the best next pose comes out; by stage, by gain and by
/// number of candidates. Beside it the same two steps by OctoMap, for the camel's maps. Returns the
/// exit code.
int run_decision(const DecisionOptions& options);

/// Of camel-128: medians [ms] of the stages, then of what choosing takes, in their order.
[[nodiscard]] std::vector<std::pair<std::string, double>> stage_milliseconds(
    const DecisionOptions& options);

}  // namespace viewgain::bench
