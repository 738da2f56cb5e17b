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
  std::filesystem::path map{};  ///< .vdb of a room; empty: one made in memory
  int poses = 500;              ///< in the room
  int subsets = 60;             ///< of 100 of these
  int maps = 0;                 ///< of objects instead of the room, 2,000 poses each
  int tuned_maps = 20;          ///< the first ones, which estimates were tuned on: reported apart
  std::uint64_t seed = 1;       ///< of poses and subsets, and of race and approximate
  std::string gain = "paper";
  bool json = false;
};

/// Does race() find the best pose, and how long does it take? Do the standard errors of
/// approximate() hold? In a room for three sensors, or on maps of objects. Prints a table or JSON;
/// 1 if a bar is missed.
int run_choose(const ChooseOptions& options);

}  // namespace viewgain::bench
