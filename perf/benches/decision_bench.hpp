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
  /// - camel-N: N voxels per side of the 0.4 m workspace, after eight views
  /// - room: a recording
  /// - hall: kHallWorkspace, voxels of 5 cm, 60 frames
  std::vector<std::string> maps{"camel-128", "camel-512", "hall"};
  std::vector<std::size_t> candidates{100, 500, 2000};
  std::filesystem::path mesh;       ///< of the camel
  std::filesystem::path recording;  ///< of the room, for open_frames()
  double room_voxel = 0.02;         ///< [m]
  bool json = false;
};

/// Measures the time from a frame to the best pose, by stage, gain and number of candidates. For
/// the maps of the camel, OctoMap does the same two steps. Returns the exit code.
int run_decision(const DecisionOptions& options);

/// Medians [ms] for camel-128: the stages in their order, then the choices.
[[nodiscard]] std::vector<std::pair<std::string, double>> stage_milliseconds(
    const DecisionOptions& options);

}  // namespace viewgain::bench
