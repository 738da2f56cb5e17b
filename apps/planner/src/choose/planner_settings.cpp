// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "choose/planner_settings.hpp"

#include "viewgain/planner/stop_settings.hpp"

namespace viewgain::detail {

MapModelConfig map_config(const PlannerConfig& config) {
  MapModelConfig map;
  map.grid = config.grid;
  map.integration = config.integration;
  map.jump_edges = config.jump_edges;
  map.surroundings = config.surroundings;
  map.hazard = config.hazard;
  map.criterion = config.gain.criterion;
  map.follow_surface = config.gain.model != GainModel::paper;
  return map;
}

ProposerConfig proposer_config(const PlannerConfig& config, const Sensor& sensor) {
  FeasibilityConfig feasibility = feasibility_of(sensor);
  feasibility.clearance = config.clearance;
  feasibility.reach = config.reach;
  feasibility.taken_tolerance = config.taken_tolerance;
  feasibility.max_near_share = config.max_near_share;
  return {std::move(feasibility), config.check_feasibility};
}

PlanningConfig planning_config(const PlannerConfig& config) {
  PlanningConfig planning;
  planning.max_views = config.max_views;
  planning.idle_views = config.idle_views;
  planning.broken_promises = config.broken_promises;
  set_stop_rules(planning, config.gain.model, config.gain.criterion, config.stop_gain,
                 config.stop_area);
  return planning;
}

}  // namespace viewgain::detail
