// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "choose/planner_settings.hpp"

#include "viewgain/planner/feasible_poses.hpp"
#include "viewgain/planner/stop_settings.hpp"

namespace viewgain::detail {
namespace {

GridConfig grid_config(const PlannerConfig& config, const Sensor& sensor) {
  GridConfig grid = config.grid;
  if (grid.prior_sigma == 0) grid.prior_sigma = default_prior_sigma(grid.voxel_size, sensor);
  return grid;
}

}  // namespace

MapModelConfig map_config(const PlannerConfig& config, const Sensor& sensor) {
  MapModelConfig map;
  map.grid = grid_config(config, sensor);
  map.integration.support_plane = config.support_plane;
  map.jump_edges = config.jump_edges;
  map.obstacles = config.obstacles;
  map.hazard = config.hazard;
  map.criterion = config.gain.criterion;
  map.follow_surface = config.gain.model != GainModel::paper;
  return map;
}

GainConfig gain_config(const PlannerConfig& config) {
  GainConfig gain = config.gain;
  gain.support_plane = config.support_plane;
  return gain;
}

FeasibilityConfig feasibility_config(const PlannerConfig& config, const Sensor& sensor) {
  FeasibilityConfig feasibility = feasibility_of(sensor);
  feasibility.clearance = config.clearance;
  feasibility.reach = config.reach;
  feasibility.taken_tolerance = config.taken_tolerance;
  feasibility.support_plane = config.support_plane;
  feasibility.max_near_share = config.max_near_share;
  return feasibility;
}

PlanningConfig planning_config(const PlannerConfig& config) {
  PlanningConfig planning;
  planning.max_views = config.max_views;
  planning.idle_views = config.idle_views;
  set_stop_rules(planning, config.gain.model, config.gain.criterion, config.stop_gain,
                 config.stop_area);
  return planning;
}

}  // namespace viewgain::detail
