// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/sensing.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain::app {

/// Flags of `viewgain follow`.
struct FollowOptions {
  CommonOptions common;
  FrameFolderOptions frames;
  double voxel = 0;
  std::string workspace;
  std::string jump_edge_filter = "5";
  ScaleOptions scales;
  std::string gain = default_gain();
  std::optional<double> object_size;
  std::string hazard;
  std::string reach;
  std::vector<std::string> obstacles;
  std::string body;
  std::optional<double> support_plane;
  std::size_t top = 10;
  PlanOptions plan;
  double cost_per_metre = 0;
  std::size_t max_views = PlannerConfig{}.max_views;
  std::size_t stop_promises = PlannerConfig{}.broken_promises;
  RegistrationOptions registration;
  std::string out;
};

void add_follow_options(App& app, FollowOptions& options);

/// Settings of the map, without those that depend on the sensor. Throws Error, naming the flag.
[[nodiscard]] ScorerConfig scorer_config(const FollowOptions& options);
/// Settings of the planner. Throws Error, naming the flag.
[[nodiscard]] PlannerConfig planner_config(const FollowOptions& options);

}  // namespace viewgain::app
