// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace viewgain::bench {

struct ChooseOptions {
  int num_threads = 0;
  std::filesystem::path map{};  ///< map of a room (.vdb); empty: made in memory
  int poses = 500;              ///< number of poses in the room
  int subsets = 60;             ///< number of races, each among 100 of these
  int maps = 0;            ///< number of maps of objects instead of the room, with 2,000 poses each
  int tuned_maps = 20;     ///< first maps, used for tuning and reported separately
  std::uint64_t seed = 1;  ///< of poses, subsets, race and approximate
  std::string gain = "paper";
  bool json = false;
};

/// Measures how often race() finds the best pose, how long it takes, and whether the standard
/// errors of approximate() are right. Runs in a room with three sensors, or on maps of objects.
/// Prints a table or JSON. Returns the exit code: 1 if a bar is missed.
int run_choose(const ChooseOptions& options);

}  // namespace viewgain::bench
