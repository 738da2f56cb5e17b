// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/pose_source.hpp"

namespace viewgain::app {

/// Flags of `viewgain score`.
struct ScoreOptions {
  CommonOptions common;
  std::string map;
  PoseOptions poses;
  std::string sensor;
  std::string gain = default_gain();
  std::optional<double> support_plane;
  std::string hazard, reach, body;
  std::vector<std::string> obstacles;
  std::string feasible = "off";
  std::string criterion = "log_diagonal";
  std::vector<std::string> weights;
  std::optional<double> prior_sigma;
  CostOptions costs;
  std::size_t top = 10;
  bool race = false;
  std::optional<double> deadline;     // time limit of the race [s]
  std::optional<double> approximate;  // fraction of the rays
  std::optional<std::size_t> set;     // number of views in a set
  std::uint64_t seed = 1;
  std::string out;
  std::string picture;
  std::string report;
};

}  // namespace viewgain::app
