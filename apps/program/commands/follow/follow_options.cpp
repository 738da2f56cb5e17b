// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/follow/follow_options.hpp"

#include "program/cli/flags/pose_source.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/reach_toml.hpp"

namespace viewgain::app {

ScorerConfig scorer_config(const FollowOptions& options) {
  ScorerConfig config;
  check_positive("--voxel", options.voxel);
  config.voxel_size = options.voxel;
  config.workspace = parse_box("--workspace", options.workspace);
  if (options.support_plane) check_finite("--support-plane", *options.support_plane);
  config.support_plane = options.support_plane;
  config.obstacles = obstacles_of(options.obstacles);
  config.jump_edges = parse_jump_edge_filter(options.jump_edge_filter);
  options.scales.set(config);
  config.gain.model = parse_gain_model(options.gain);
  if (config.gain.model == GainModel::paper && (options.object_size || !options.hazard.empty())) {
    refuse("--object-size and --hazard go with --gain surface or combined");
  }
  return config;
}

PlannerConfig planner_config(const FollowOptions& options) {
  PlannerConfig config;
  if (!options.reach.empty()) config.reach = read_reach_toml(options.reach);
  config.max_views = options.max_views;
  config.broken_promises = options.stop_promises;
  check_at_least_0("--cost-per-metre", options.cost_per_metre);
  check(options.plan);
  config.ahead = options.plan.ahead();
  return config;
}

void add_follow_options(App& app, FollowOptions& o) {
  app.add_option("FRAMES_DIR", o.frames.folder, "folder of frames, as for integrate")->required();
  app.add_option("--voxel", o.voxel, "voxel size [m]")->required();
  app.add_option("--workspace", o.workspace, "x0,y0,z0,x1,y1,z1 [m], grown to whole voxels")
      ->required();
  app.add_option("--sensor", o.frames.sensor, kSensorHelp + "; default: FRAMES_DIR/sensor.toml");
  add_frame_folder_options(app, o.frames);
  app.add_option("--jump-edge-filter", o.jump_edge_filter, kJumpEdgeHelp);
  add_scale_options(app, o.scales);
  app.add_option("--gain", o.gain,
                 "that views are ranked by: paper, surface or combined, as in score")
      ->check(one_of_gain_models());
  app.add_option("--object-size", o.object_size, kObjectSizeHelp);
  app.add_option("--hazard", o.hazard, kHazardHelp);
  app.add_option("--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach");
  app.add_option("--obstacle", o.obstacles, kObstacleHelp)->allow_extra_args(false);
  app.add_option("--body", o.body, kBodyHelp);
  app.add_option("--support-plane", o.support_plane,
                 "height z of the table [m]: its readings carve but do not hit; default: none");
  app.add_option("--top", o.top,
                 "how many views to say, at most, each by what it adds to those before it")
      ->check(counted(1, 1'000'000));
  add_plan_options(app, o.plan);
  app.add_option("--cost-per-metre", o.cost_per_metre, kCostPerMetreHelp);
  app.add_option("--max-views", o.max_views, "view budget: a reason to stop")
      ->check(counted(1, 1'000'000));
  app.add_option("--stop-promises", o.stop_promises, kStopPromisesHelp)
      ->check(counted(0, 1'000'000));
  add_registration_options(app, o.registration);
  app.add_option("--out", o.out, "folder for state.vdb, next.txt, next.json")->required();
  add_trace_option(app, o.common);
  add_common_options(app, o.common);
  add_help(app, kViewsGroup,
           "follow frames --voxel 0.005 --workspace -0.2,-0.2,-0.2,0.2,0.2,0.2 --out plan");
}

}  // namespace viewgain::app
