// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/proposal/view_proposal.hpp"

#include <algorithm>
#include <utility>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/help.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

bool has_generator(const ProposalOptions& options, const char* name) {
  const std::vector<std::string> names = names_in(options.generator);
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_at_boundaries(const ProposalOptions& options) {
  if (options.generator.empty()) return options.poses.empty();
  return has_generator(options, "boundary");
}

// Settings of the ranking. The costs must outlive the result.
RankConfig rank_config(const ProposalOptions& options, const std::vector<double>& costs,
                       const std::optional<Pose>& last_pose) {
  return {.costs = costs,
          .cost_per_metre = options.costs.per_metre,
          .current_pose = begin_of_ways(options.costs, last_pose)};
}

BatchControl shown_on(Progress& progress) {
  BatchControl control;
  control.progress = [&](std::size_t done, std::size_t total) { progress.update(done, total); };
  return control;
}

// Cost of each candidate; empty without --costs.
std::vector<double> costs_of(const ProposalOptions& options, const Proposal& proposal) {
  if (options.costs.file.empty()) return {};
  const std::vector<double> given = read_costs(options.costs.file, poses_in(options.poses).size());
  std::vector<double> costs;
  for (const Candidate& candidate : proposal.candidates) {
    costs.push_back(candidate.generator == kGivenPoses ? given[candidate.number.value()] : 0);
  }
  return costs;
}

PoseSetRequest request_of(const ProposalOptions& options, const Sensor& sensor,
                          const BeliefGrid& grid, const ReachRegion& reach) {
  PoseSetRequest request = around_workspace(grid, sensor);
  if (!options.center.empty()) request.center = parse_point("--center", options.center);
  if (options.distance) {
    request.distance = *options.distance;
  } else {
    request.reach = reach;
  }
  request.count = options.count;
  request.seed = options.seed;
  return request;
}

}  // namespace

void add_next_view_options(App& app, ProposalOptions& o) {
  begin_group(app, "Candidates");
  app.add_option("--generator", o.generator,
                 "sources of candidates, separated by commas; see below (default: boundary, or "
                 "sphere if the map has no surface or no views)")
      ->check(several_of(generator_names(), "generator"));
  explain_values(app,
                 "Sources of candidates for --generator:\n"
                 "  boundary  facing open edges of the surface and places where more surface is\n"
                 "            expected; default --distance: the sensor's working distance\n"
                 "  sphere, dome, rings, sequence  sets of poses around --center; at the default\n"
                 "            --distance, the workspace fills the image\n"
                 "  shell     random poses in the shells or boxes of the --reach file; without\n"
                 "            --reach, around --center\n");
  app.add_option(
      "--poses", o.poses,
      "TUM or .npy file of camera-to-world poses to choose from; --generator adds more candidates");
  add_cost_options(app, o.costs, "--poses");
  app.add_option("--count", o.count,
                 "number of poses for sphere, dome or shell (default: 500), or for rings (48, 80, "
                 "288 or 864; default: 48)")
      ->check(counted(1, 1'000'000));
  app.add_option("--distance", o.distance,
                 "distance of candidates [m]: from the surface for boundary, from --center for "
                 "others (default: see below)");
  app.add_option("--center", o.center,
                 "x,y,z: point that sets of poses look at, world frame [m] (default: the centre of "
                 "the workspace)");
  app.add_option(
      "--reach", o.reach,
      "TOML file of poses that the robot can reach (default: no limit; for boundary, the "
      "workspace if it contains all views so far)");
  begin_group(app, "Obstacles");
  app.add_option("--body", o.body, kBodyHelp);
  app.add_option("--support-plane", o.support_plane,
                 "height z of the table under the object [m] (default: none)");
  app.add_option("--obstacle", o.obstacles, kObstacleHelp)->allow_extra_args(false);
  begin_group(app, "Gain and order");
  add_hazard_option(app, o.hazard);
  add_seed_option(app, o.seed, "seed for the random poses of shell");
  app.add_option("--gain", o.gain, "gain that ranks the views (see viewgain score --help)")
      ->check(one_of_gain_models());
  add_plan_option(app, o.plan);
}

void check(const ProposalOptions& options) {
  const bool boundary = is_at_boundaries(options);
  const std::vector<std::string> names = names_in(options.generator);
  const auto sets = std::count_if(names.begin(), names.end(), [](const std::string& name) {
    return name != "boundary" && name != "sequence";
  });
  if (options.count && sets == 0 && (options.poses.empty() || !names.empty())) {
    refuse("--count requires --generator sphere, dome, rings or shell, not " +
           (names.empty() ? "boundary" : options.generator));
  }
  if (!options.center.empty() && sets == 0 && boundary && !has_generator(options, "sequence")) {
    refuse("--center cannot be used with --generator boundary");
  }
  if (options.distance) check_positive("--distance", *options.distance);
  check(options.costs, parse_plan(options.plan).is_on());
  if (!options.poses.empty() && options.generator.empty() &&
      (options.count || options.distance || !options.center.empty())) {
    refuse("--count, --distance and --center require --generator when --poses is given");
  }
  if (!options.costs.file.empty() && options.poses.empty()) refuse("--costs requires --poses");
  if (options.support_plane) check_finite("--support-plane", *options.support_plane);
  if (parse_gain_model(options.gain) == GainModel::paper && !options.hazard.empty()) {
    refuse("--hazard requires --gain surface or combined");
  }
}

Sensor with_body(Sensor sensor, const ProposalOptions& options) {
  if (!options.body.empty()) sensor.body_size = parse_size("--body", options.body);
  return sensor;
}

SurfaceModel model_of(BeliefGrid grid, const Sensor& sensor, const ProposalOptions& options,
                      Obstacles obstacles, const ExecConfig& exec) {
  SurfaceModelConfig config;
  config.map.hazard = hazard_source(options.hazard, grid);
  config.map.obstacles = std::move(obstacles);
  config.map.support_plane = options.support_plane;
  return {std::move(grid), sensor, config, exec};
}

GenerationConfig generation_config(const ProposalOptions& options, const Sensor& sensor,
                                   const BeliefGrid& grid, const std::string& map,
                                   const std::vector<Pose>& tried) {
  GenerationConfig config = default_generation(sensor, grid.voxel_size());
  config.tried = tried;
  config.at_boundaries = is_at_boundaries(options);
  if (options.distance) config.boundary.working_distance = *options.distance;
  if (!options.reach.empty()) config.feasibility.reach = read_reach_toml(options.reach);
  if (!map.empty() && has_generator(options, "boundary") && grid.views().empty()) {
    refuse(map + ": --generator boundary requires a map with views; use --generator sphere");
  }
  if (!options.poses.empty()) config.sets.push_back({kGivenPoses, poses_in(options.poses)});
  const PoseSetRequest request = request_of(options, sensor, grid, config.feasibility.reach);
  for (const std::string& name : names_in(options.generator)) {
    if (name != "boundary") config.sets.push_back(make_pose_set(name, request));
  }
  return config;
}

GainEvaluator evaluator_of(const ProposalOptions& options, const SurfaceModel& model,
                           const Sensor& sensor, const ExecConfig& exec) {
  GainConfig config;
  config.model = parse_gain_model(options.gain);
  return {model.scene(), sensor, config, exec};
}

void warn_of_set_up(const ProposalOptions& options, const Obstacles& obstacles,
                    const BeliefGrid& grid, const Sensor& sensor, bool frames_follow) {
  std::optional<ReachRegion> reach;
  if (!options.reach.empty()) reach = read_reach_toml(options.reach);
  warn_of_set_up({.sensor = sensor,
                  .map = grid,
                  .frames_follow = frames_follow,
                  .obstacle_values = &options.obstacles,
                  .obstacles = &obstacles,
                  .support_plane = options.support_plane,
                  .reach_file = options.reach,
                  .reach = reach ? &*reach : nullptr,
                  .object_size = object_size_of(options.hazard)});
}

void warn_of_views(const ProposalOptions& options, const Obstacles& obstacles,
                   const SurfaceModel& model, const Sensor& sensor) {
  warn_of_views_in_obstacles(obstacles, model.grid());
  if (options.poses.empty()) return;
  warn_of_poses(options.poses, poses_in(options.poses), model.scene(), sensor);
}

NextViews best_views(const GainEvaluator& evaluator, const Proposal& proposal,
                     const ProposalOptions& options, const std::optional<Pose>& last_pose,
                     std::size_t top, bool quiet) {
  Progress progress("pose", quiet);
  const BatchControl control = shown_on(progress);
  const std::vector<double> costs = costs_of(options, proposal);
  RankConfig config = rank_config(options, costs, last_pose);
  config.together = true;
  const std::vector<Pose> poses = poses_of(proposal.candidates);
  PlanAhead ahead = parse_plan(options.plan);
  ahead.least_share = 0;  // views that add little are listed too
  Ranking ranking = ahead.is_on() ? plan_views(evaluator, poses, ahead, 0.0, config, control)
                                  : rank_views(evaluator, poses, top, config, control);
  progress.wipe();
  leave_out_gainless(ranking, config);
  const std::size_t found = ranking.views.size();
  const std::size_t most = ahead.is_on() ? ahead.take : top;
  ranking.views.resize(std::min(ranking.views.size(), most));
  NextViews next = next_views(ranking, proposal, evaluator.model());
  if (ahead.is_on()) next.plan_metres = ranking.way;
  const bool has_costs = !costs.empty() || options.costs.per_metre > 0;
  next.all_worth = !has_costs || found >= std::min(most, poses.size());
  return next;
}

NextViews all_views(const GainEvaluator& evaluator, const Proposal& proposal,
                    const ProposalOptions& options, const std::optional<Pose>& last_pose,
                    bool quiet) {
  Progress progress("pose", quiet);
  const std::vector<double> costs = costs_of(options, proposal);
  RankConfig config = rank_config(options, costs, last_pose);
  config.exact = true;
  const std::vector<Pose> poses = poses_of(proposal.candidates);
  Ranking ranking;
  if (!poses.empty()) {
    ranking = rank_views(evaluator, poses, poses.size(), config, shown_on(progress));
  }
  progress.wipe();
  NextViews all = next_views(ranking, proposal, evaluator.model());
  all.together = false;
  return all;
}

}  // namespace viewgain::app
