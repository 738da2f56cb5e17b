// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/pose_source.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/help.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/score/score_options.hpp"
#include "program/commands/score/score_registered.hpp"
#include "program/commands/score/score_report.hpp"
#include "program/commands/score/score_set_up.hpp"
#include "show/pictures/map_picture.hpp"
#include "show/report/page.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

using Options = ScoreOptions;

void check_feasibility(const Options& options) {
  if (options.deadline && !options.race) refuse("--deadline requires --race");
  if (options.deadline) check_at_least_0("--deadline", *options.deadline);
  if (!options.body.empty() && options.feasible == "off") refuse("--body requires --feasible on");
  if (options.support_plane) check_finite("--support-plane", *options.support_plane);
  check(options.costs);
  if (options.set && !options.costs.none()) {
    refuse("--costs and --cost-per-metre cannot be used with --set");
  }
}

GainConfig gain_config(const Options& options) {
  GainConfig config;
  config.model = parse_gain_model(options.gain);
  if (config.model == GainModel::paper && !options.hazard.empty()) {
    refuse("--hazard requires --gain surface or combined");
  }
  if (config.model == GainModel::paper && options.support_plane && options.feasible == "off") {
    refuse("--support-plane requires --feasible on, or --gain surface or combined");
  }
  if (config.model != GainModel::paper && options.criterion != "log_diagonal") {
    refuse("--criterion " + options.criterion + " requires --gain paper, not " + options.gain);
  }
  config.criterion = parse_criterion(options.criterion);
  config.posterior_entropy = true;  // a column of the output
  config.prior_sigma = options.prior_sigma;
  for (const std::string& text : options.weights) {
    const std::vector<double> numbers = parse_numbers("--weight", text, 7, 7);
    config.weights.push_back({box_of("--weight", numbers), numbers[6]});
  }
  return config;
}

std::shared_ptr<const VoxelScene> scene_of(const Options& options, const BeliefGrid& grid,
                                           const Sensor& sensor, const ExecConfig& exec,
                                           const HazardConfig& hazard = {}) {
  const Obstacles obstacles = obstacles_of(options.obstacles);
  warn_of_set_up(options, obstacles, grid, sensor);
  return VoxelScene::build(grid, {obstacles, options.support_plane}, exec, hazard);
}

// The poses to score: all, those in reach, or the feasible ones.
FeasiblePoses candidates_of(const Options& options, const PoseSource& source, const Sensor& sensor,
                            const BeliefGrid& grid, const std::shared_ptr<const VoxelScene>& scene,
                            const ExecConfig& exec) {
  if (!is_set_of_poses(options.poses.poses)) {
    warn_of_poses(options.poses.poses, source.poses, scene, sensor);
  }
  ReachRegion reach;
  if (!options.reach.empty()) reach = read_reach_toml(options.reach);
  if (options.feasible == "off") return reachable_poses(reach, source.poses);
  FeasibilityConfig config = feasibility_of(sensor);
  if (!options.body.empty()) config.body.size = parse_size("--body", options.body);
  config.reach = std::move(reach);
  return feasible_poses(FeasibilityChecker(scene, config, exec), source.poses, grid.views());
}

void check_left(const FeasiblePoses& candidates) {
  if (!candidates.poses.empty()) return;
  refuse("all poses were dropped: " + counts_text(candidates.dropped));
}

// Costs of the poses, feasible or not.
std::vector<double> costs_of(const Options& options, const PoseSource& source,
                             const BeliefGrid& grid) {
  std::vector<double> costs;
  if (!options.costs.file.empty()) costs = read_costs(options.costs.file, source.poses.size());
  return view_costs(source.poses, {.costs = costs,
                                   .cost_per_metre = options.costs.per_metre,
                                   .current_pose = begin_of_ways(options.costs, last_view(grid))});
}

// Calls work(control) with a progress display. Returns its duration [s].
template <typename Work>
double timed(const Options& options, const Work& work) {
  Progress progress("pose", options.common.quiet);
  BatchControl control;
  control.progress = [&progress](std::size_t done, std::size_t total) {
    progress.update(done, total);
  };
  const Stopwatch watch;
  work(control);
  return watch.seconds();
}

// Ranks by gain minus cost, if there are costs.
std::vector<std::size_t> best_by_worth(std::vector<ViewGain> gains,
                                       const std::vector<double>& costs, std::size_t k) {
  for (std::size_t i = 0; i < costs.size(); ++i) gains[i].gain -= costs[i];
  return best_indices(gains, k);
}

Scores scored(const ScoreOptions& options, const GainEvaluator& evaluator,
              const std::vector<Pose>& poses, const std::vector<double>& costs,
              const BatchControl& control) {
  Scores scores;
  scores.scored.gains.resize(poses.size());
  evaluator.evaluate(poses, scores.scored.gains, control);
  scores.scored.indices.resize(poses.size());
  std::iota(scores.scored.indices.begin(), scores.scored.indices.end(), std::size_t{0});
  scores.best.indices = best_by_worth(scores.scored.gains, costs, options.top);
  for (const std::size_t i : scores.best.indices) {
    scores.best.gains.push_back(scores.scored.gains[i]);
  }
  for (const ViewGain& gain : scores.scored.gains) scores.rays_traced += gain.rays;
  return scores;
}

Scores raced(const ScoreOptions& options, const GainEvaluator& evaluator,
             const std::vector<Pose>& poses, const std::vector<double>& costs,
             const BatchControl& control) {
  BestConfig config{.costs = costs, .seed = options.seed};
  config.deadline = options.deadline.value_or(config.deadline);
  BestViews views = evaluator.race(poses, options.top, config, control);
  return {.scored = {std::move(views.scored_indices), std::move(views.scored_gains)},
          .best = {std::move(views.indices), std::move(views.gains)},
          .rays_traced = views.rays_traced,
          .estimated = views.estimated};
}

Scores chosen_together(const ScoreOptions& options, const GainEvaluator& evaluator,
                       const std::vector<Pose>& poses, const BatchControl& control) {
  ViewSet set = evaluator.best_set(poses, *options.set, control);
  const ScoredViews views{std::move(set.indices), std::move(set.marginal)};
  return {.scored = views,
          .best = views,
          .set_gain = set.gain,
          .set_gain_by_best_alone = set.gain_by_best_alone,
          .rays_traced = set.evaluations * evaluator.rays_per_pose()};
}

Scores estimated(const ScoreOptions& options, const GainEvaluator& evaluator,
                 const std::vector<Pose>& poses, const std::vector<double>& costs,
                 const BatchControl& control) {
  const ApproximateConfig config{.share = *options.approximate, .seed = options.seed};
  Scores scores{.estimates = Estimates{}, .estimated = poses.size()};
  Estimates& estimates = *scores.estimates;
  estimates.gains.resize(poses.size());
  evaluator.approximate(poses, estimates.gains, config, control);
  std::vector<ViewGain> ranked(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ranked[i].gain = estimates.gains[i].gain;
    scores.rays_traced += estimates.gains[i].rays;
  }
  estimates.best = best_by_worth(std::move(ranked), costs, options.top);
  return scores;
}

/// Scores the poses according to the flags. `costs`: one per pose, subtracted from the gains for
/// ranking; empty: none. Indices are those of `poses`.
Scores make_scores(const ScoreOptions& options, const GainEvaluator& evaluator,
                   const std::vector<Pose>& poses, const std::vector<double>& costs,
                   const BatchControl& control) {
  if (options.race) return raced(options, evaluator, poses, costs, control);
  if (options.set) return chosen_together(options, evaluator, poses, control);
  if (options.approximate) return estimated(options, evaluator, poses, costs, control);
  return scored(options, evaluator, poses, costs, control);
}

// Converts indices of candidates to rows of the given poses.
void name_by_input(Scores& scores, const FeasiblePoses& candidates) {
  const auto name = [&](std::vector<std::size_t>& indices) {
    for (std::size_t& i : indices) i = candidates.numbers[i];
  };
  name(scores.scored.indices);
  name(scores.best.indices);
  if (scores.estimates) scores.estimates->indices = candidates.numbers;
  scores.candidates = candidates.poses.size();
  scores.dropped = candidates.dropped;
}

// Warns if unknown voxels would count as more certain than a reading.
void warn_of_prior(const GainEvaluator& evaluator, const Sensor& sensor) {
  const double axial = sensor.sigmas(sensor.working_distance).axial;
  if (evaluator.prior_sigma() >= axial) return;
  std::fprintf(
      stderr,
      "viewgain: warning: the prior sigma is %.3g m, less than the sensor's noise of %.3g m along "
      "the ray at a range of %g m. Unknown voxels would count as more certain than measured "
      "voxels; increase --prior-sigma\n",
      evaluator.prior_sigma(), axial, sensor.working_distance);
}

void score_by_registered_gains(const Options& options, const std::vector<std::string>& names) {
  const ExecConfig exec = exec_of(options.common);
  const PoseSource source = make_poses(options.poses, options.seed);
  const SensedMap map = load_sensed_map(options.map, options.sensor, exec);
  const auto& [grid, sensor] = map;
  const auto scene = scene_of(options, grid, sensor, exec);
  const auto evaluator = registered_gains().evaluator(scene, grid, sensor, names, exec);
  FeasiblePoses candidates = candidates_of(options, source, sensor, grid, scene, exec);
  check_left(candidates);

  RegisteredScores scores{.grid = grid,
                          .sensor = sensor,
                          .source = source,
                          .scene = *scene,
                          .names = names,
                          .rays_per_pose = evaluator->rays_per_pose(),
                          .threads = thread_count(exec.num_threads),
                          .numbers = candidates.numbers,
                          .dropped = candidates.dropped};
  scores.gains.resize(candidates.poses.size() * names.size());
  scores.statuses.resize(candidates.poses.size());
  scores.seconds = timed(options, [&](const BatchControl& control) {
    evaluator->evaluate(candidates.poses, 1, scores.gains, scores.statuses, control);
  });
  if (!options.out.empty()) write_table(options.out, with_poses(scores.table(), source));
  if (options.common.json) {
    scores.print_json(options.top);
  } else {
    scores.print_table(options.top);
  }
}

void score(const Options& options) {
  check_feasibility(options);
  if (const auto names = registered_gains_of(options)) {
    return score_by_registered_gains(options, *names);
  }
  if (!options.report.empty()) check_report_page("--report");
  const ExecConfig exec = exec_of(options.common);
  const GainConfig config = gain_config(options);
  PoseSource source = make_poses(options.poses, options.seed);
  const SensedMap map = load_sensed_map(options.map, options.sensor, exec);
  const BeliefGrid& grid = map.grid;
  const Sensor& sensor = map.sensor;
  source.costs = costs_of(options, source, grid);
  const HazardConfig hazard = hazard_source(options.hazard, grid);
  const auto scene = scene_of(options, grid, sensor, exec, hazard);
  const GainEvaluator evaluator(scene, sensor, config, exec);
  FeasiblePoses candidates = candidates_of(options, source, sensor, grid, scene, exec);
  check_left(candidates);
  std::vector<double> costs;  // costs of the candidates
  for (const std::size_t i : candidates.numbers) {
    if (!source.costs.empty()) costs.push_back(source.costs[i]);
  }

  Scores scores;
  const double seconds = timed(options, [&](const BatchControl& control) {
    scores = make_scores(options, evaluator, candidates.poses, costs, control);
  });
  name_by_input(scores, candidates);
  warn_of_prior(evaluator, sensor);
  if (!options.picture.empty()) {
    const std::optional<std::size_t> winner = scores.winner();
    const Pose& shown = winner ? source.poses.at(*winner)
                               : candidates.poses[evaluator.race(candidates.poses).indices.at(0)];
    write_png(options.picture, score_picture(evaluator, sensor, shown, exec));
  }
  if (!options.out.empty()) {
    write_table(options.out, with_poses(table_of(scores, config.model), source));
  }
  const ScoreReport report{config.model, options.criterion, grid,   sensor,
                           source,       evaluator,         scores, seconds};
  if (!options.report.empty()) {
    write_report(options.report, report.page(std::filesystem::path(options.map).filename()));
  }
  if (options.common.json) {
    report.print_json();
  } else {
    report.print_table();
  }
}

}  // namespace

Command add_score(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "score",
      "Score candidate poses by expected information gain in a map and print the best ones.");
  app->add_option("MAP", options->map, kMapHelp)->required();
  add_pose_options(*app, options->poses);
  app->add_option("--sensor", options->sensor, kMapSensorHelp);
  begin_group(*app, "Gain");
  app->add_option(
         "--gain", options->gain,
         "paper (entropy removed) [nat], surface (new surface) [m^2], combined [nat], or "
         "a gain of the literature; several, separated by commas (the first ranks the poses)")
      ->check(several_of(all_gain_names(), "gain"));
  add_hazard_option(*app, options->hazard);
  begin_group(*app, "Obstacles");
  app->add_option(
      "--support-plane", options->support_plane,
      "height z of a table [m] (default: none); with --gain surface or combined, rays end there; "
      "with --feasible on, the camera stays above it");
  app->add_option("--obstacle", options->obstacles, kObstacleHelp)->allow_extra_args(false);
  app->add_option("--reach", options->reach,
                  "TOML file of poses that the robot can reach; other poses are dropped");
  add_switch(
      *app, "--feasible", options->feasible,
      "drop poses where the camera's housing could touch something, where surface is too near, or "
      "where the map already has a view");
  app->add_option("--body", options->body, kBodyHelp);
  begin_group(*app, "Gain");
  app->add_option("--criterion", options->criterion,
                  "criterion of the gain paper: log_diagonal (as published) [nat], log_determinant "
                  "[nat] or trace [m^2]")
      ->check(one_of(criterion_names(), "criterion"));
  app->add_option(
         "--weight", options->weights,
         "x0,y0,z0,x1,y1,z1,W: multiply the gain of voxels in this box (grid frame [m]) by W >= 0; "
         "where boxes overlap, the last box counts; may be repeated")
      ->allow_extra_args(false);
  app->add_option("--prior-sigma", options->prior_sigma,
                  "standard deviation of an unknown voxel [m] (default: from the map)");
  begin_group(*app, "Order");
  add_cost_options(*app, options->costs, "--poses");
  app->add_option("--top", options->top, "number of poses to print, best first")
      ->check(counted(0, 1'000'000'000));
  auto* selection = app->add_option_group("selection", "at most one of; default: score all poses");
  selection->add_flag(
      "--race", options->race,
      "estimate all gains with few rays, then score the best poses with all rays; rarely "
      "misses the best pose (cannot be used with --approximate, --set)");
  selection
      ->add_option("--approximate", options->approximate,
                   "trace at most this share of each view's rays, and estimate gains with their "
                   "standard errors (cannot be used with --race, --set)")
      ->check(CLI::Range(1e-6, 1.0, "share in (0, 1]"));
  selection
      ->add_option("--set", options->set,
                   "K: choose K views that are best together and print their marginal gains "
                   "(cannot be used with --race, --approximate)")
      ->check(counted(1, 1'000'000));
  selection->require_option(0, 1);
  app->add_option(
      "--deadline", options->deadline,
      "time limit for --race [s], after which the best ranking found so far is printed (requires "
      "--race; default: none)");
  add_seed_option(
      *app, options->seed,
      "seed for --poses shell:..., for --approximate, and for --race with --gain paper");
  begin_group(*app, "Output");
  app->add_option("--out", options->out,
                  "CSV or .npy file for the scores of all poses that were not dropped, in input "
                  "order (with --race, only poses scored with all rays; with --set, only the set)");
  app->add_option("--picture", options->picture,
                  "PNG file to write, showing the map, the frustum of the best view and the voxels "
                  "where its rays may end (drawn larger if more likely)");
  app->add_option(
      "--report", options->report,
      "HTML file to write, showing the map, the candidates coloured by gain, the ranking "
      "and what the best views see");
  most_need(*app, {"--sensor", "--gain", "--top", "--out", "--reach", "--feasible", "--race",
                   "--report"});
  add_help(*app, kViewsGroup,
           "score map.vdb --poses sphere:500,0.6 --sensor sr4000 --gain surface --top 5");
  return command_of(app, options, score);
}

}  // namespace viewgain::app
