// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/proposal/view_proposal.hpp"

#include <utility>
#include <vector>

#include "program/cli/choices.hpp"
#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/hazard_source.hpp"
#include "program/cli/flags/obstacle_source.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/rank_views.hpp"

namespace viewgain::app {
namespace {

bool is_at_boundaries(const ProposalOptions& options) {
  return options.generator.empty() || options.generator == "boundary";
}

PoseSetRequest request_of(const ProposalOptions& options, const Sensor& sensor,
                          const BeliefGrid& grid) {
  PoseSetRequest request = around_workspace(grid, sensor);
  if (!options.center.empty()) request.center = parse_point("--center", options.center);
  if (options.distance) request.distance = *options.distance;
  request.count = options.count;
  request.seed = options.seed;
  return request;
}

}  // namespace

void add_proposal_options(App& app, ProposalOptions& o) {
  const EstimatorConfig usual = default_estimator(1.0);
  app.add_option("--count", o.count,
                 "poses of the sphere, dome or shell (default 500); rings: 48, 80, 288 or 864 "
                 "(default 48)")
      ->range(std::size_t{1}, std::size_t{1'000'000}, "count");
  app.add_option("--distance", o.distance,
                 "boundary: from the surface; else from the centre [m]; default: the sensor's "
                 "working distance; the workspace fills the view");
  app.add_option("--center", o.center,
                 "x,y,z that poses look at, world [m]; default: the workspace's centre");
  app.add_option(
      "--reach", o.reach,
      "TOML file: boxes, shells, half-spaces, poses in reach; default: all, or, for views at "
      "boundaries, the workspace if all views so far are inside of it");
  app.add_option("--body", o.body, kBodyHelp);
  app.add_option("--support-plane", o.support_plane, "height z of a table [m]");
  app.add_option("--obstacle", o.obstacles, kObstacleHelp)->allow_extra_args(false);
  app.add_option("--overlap", o.overlap,
                 std::string(kOverlapHelp) + "; default: " + short_text(usual.overlap));
  app.add_option("--region-depth", o.region_depth,
                 std::string(kRegionDepthHelp) + "; default: " + short_text(usual.region_depth));
  app.add_option("--object-size", o.object_size, kObjectSizeHelp);
  app.add_option("--hazard", o.hazard, kHazardHelp);
  add_seed_option(app, o.seed, "of the shell");
}

void add_next_view_options(App& app, ProposalOptions& o, std::size_t& top) {
  o.gain = default_gain();
  one_of(*app.add_option("--generator", o.generator,
                         "where views come from: boundary (open boundaries of the surface in the "
                         "map), sphere, dome, rings, shell or sequence; default: boundary, and a "
                         "sphere round the workspace of a map without a surface or views"),
         generator_names(), "generator");
  add_proposal_options(app, o);
  one_of(*app.add_option("--gain", o.gain, "paper, surface or combined, as in score")
              ->capture_default_str(),
         gain_model_names(), "gain");
  app.add_option("--top", top, "views to name at most")
      ->capture_default_str()
      ->range(std::size_t{1}, std::size_t{1'000'000}, "count");
}

void check(const ProposalOptions& options) {
  const bool boundary = is_at_boundaries(options), sequence = options.generator == "sequence";
  if (options.count && (boundary || sequence)) {
    throw Error(ErrorCode::invalid_argument,
                "--count goes with sets of poses, not with --generator " +
                    (boundary ? "boundary" : options.generator));
  }
  if (boundary && !options.center.empty()) {
    throw Error(ErrorCode::invalid_argument,
                "--center goes with sets of poses, not with --generator boundary");
  }
  if (!boundary && (options.overlap || options.region_depth)) {
    throw Error(ErrorCode::invalid_argument,
                "--overlap and --region-depth go with --generator boundary");
  }
  if (options.overlap) check_inside_0_1("--overlap", *options.overlap);
  if (options.region_depth) check_positive("--region-depth", *options.region_depth);
  if (options.distance) check_positive("--distance", *options.distance);
  if (options.support_plane) check_finite("--support-plane", *options.support_plane);
  const bool by_hazard =
      !options.gain.empty() && parse_gain_model(options.gain) != GainModel::paper;
  if (!by_hazard && (options.object_size || !options.hazard.empty())) {
    throw Error(ErrorCode::invalid_argument,
                "--object-size and --hazard go with --gain surface or combined");
  }
}

Sensor with_body(Sensor sensor, const ProposalOptions& options) {
  if (!options.body.empty()) sensor.body_size = parse_size("--body", options.body);
  return sensor;
}

SurfaceModel model_of(BeliefGrid grid, const Sensor& sensor, const ProposalOptions& options,
                      const ExecConfig& exec) {
  SurfaceModelConfig config;
  config.map.hazard = hazard_source(options.hazard, options.object_size, grid);
  config.map.surroundings = {obstacles_of(options.obstacles), options.support_plane};
  return {std::move(grid), sensor, config, exec};
}

GenerationConfig generation_config(const ProposalOptions& options, const Sensor& sensor,
                                   const BeliefGrid& grid, const std::string& map,
                                   const std::vector<Pose>& tried) {
  GenerationConfig config = default_generation(sensor, grid.voxel_size());
  config.tried = tried;
  config.at_boundaries = is_at_boundaries(options);
  if (options.distance) config.boundary.working_distance = *options.distance;
  if (options.overlap) config.boundary.estimator.overlap = *options.overlap;
  if (options.region_depth) config.boundary.estimator.region_depth = *options.region_depth;
  if (!options.reach.empty()) config.feasibility.reach = read_reach_toml(options.reach);
  if (options.generator == "boundary" && grid.views().empty()) {
    throw Error(ErrorCode::invalid_argument,
                map + ": has no views, which boundary candidates need; try --generator sphere");
  }
  if (!config.at_boundaries) {
    config.sets.push_back(make_pose_set(options.generator, request_of(options, sensor, grid)));
  }
  return config;
}

GainEvaluator evaluator_of(const ProposalOptions& options, const SurfaceModel& model,
                           const Sensor& sensor, const ExecConfig& exec) {
  GainConfig config;
  config.model = parse_gain_model(options.gain);
  return {model.scene(), sensor, config, exec};
}

NextViews best_views(const GainEvaluator& evaluator, const Proposal& proposal, std::size_t top) {
  const RankConfig config;
  Ranking ranking = rank_views(evaluator, poses_of(proposal.candidates), top, config, std::nullopt);
  leave_out_gainless(ranking, config);
  return next_views(ranking, proposal, evaluator.model());
}

}  // namespace viewgain::app
