// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/score/score_set_up.hpp"

#include <optional>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/reach_toml.hpp"

namespace viewgain::app {

void warn_of_set_up(const ScoreOptions& options, const Obstacles& obstacles, const BeliefGrid& grid,
                    Sensor sensor) {
  std::optional<ReachRegion> reach;
  if (!options.reach.empty()) reach = read_reach_toml(options.reach);
  if (!options.body.empty()) sensor.body_size = parse_size("--body", options.body);
  try {
    sensor.validate();
  } catch (const Error&) {  // scoring reports the error with its name
    return;
  }
  app::warn_of_set_up({.sensor = sensor,
                       .map = grid,
                       .obstacle_values = &options.obstacles,
                       .obstacles = &obstacles,
                       .support_plane = options.support_plane,
                       .reach_file = options.reach,
                       .reach = reach ? &*reach : nullptr,
                       .object_size = object_size_of(options.hazard)});
  if (options.feasible == "on") warn_of_views_in_obstacles(obstacles, grid);
}

}  // namespace viewgain::app
