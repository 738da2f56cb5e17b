// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "options/choices.hpp"
#include "options/gain_names.hpp"
#include "options/hazard_source.hpp"
#include "options/obstacle_source.hpp"
#include "options/sensed_map.hpp"
#include "options/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {
namespace {

constexpr std::string_view kCriterion = "log_diagonal";  // of all gains here

struct Options {
  CommonOptions common;
  std::string map;
  std::string generator;
  std::string sensor;
  std::optional<std::size_t> count;
  std::optional<double> distance;
  std::string center;
  std::string reach;
  std::string body;
  std::optional<double> support_plane;
  std::string gain;
  std::optional<double> overlap;
  std::optional<double> region_depth;
  std::optional<double> object_size;
  std::string hazard;
  std::vector<std::string> obstacles;
  std::uint64_t seed = 1;
  std::string out;
};

Eigen::Vector3d center_of(const Options& options, const BeliefGrid& grid) {
  if (!options.center.empty()) return parse_point("--center", options.center);
  const Box box = grid.workspace();
  return grid.T_world_grid() * Eigen::Vector3d(0.5 * (box.min[0] + box.max[0]),
                                               0.5 * (box.min[1] + box.max[1]),
                                               0.5 * (box.min[2] + box.max[2]));
}

double distance_of(const Options& options, const Sensor& sensor, const BeliefGrid& grid) {
  if (options.distance) return *options.distance;
  const Box box = grid.workspace();
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box.max[a] - box.min[a]);
  return filling_distance(sensor, 0.5 * longest * 0.35 / 0.4);  // the object in its workspace
}

// What a generator has no use for would be ignored in silence.
void check(const Options& options) {
  const bool boundary = options.generator == "boundary", sequence = options.generator == "sequence";
  if (options.count && (boundary || sequence)) {
    throw Error(ErrorCode::invalid_argument,
                "--count goes with sets of poses, not with --generator " + options.generator);
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
}

GenerationConfig generation_config(const Options& options, const Sensor& sensor,
                                   const BeliefGrid& grid) {
  GenerationConfig config = default_generation(sensor, grid.voxel_size());
  config.at_boundaries = options.generator == "boundary";
  if (options.distance) config.boundary.working_distance = *options.distance;
  if (options.overlap) config.boundary.estimator.overlap = *options.overlap;
  if (options.region_depth) config.boundary.estimator.region_depth = *options.region_depth;
  if (!options.reach.empty()) config.feasibility.reach = read_reach_toml(options.reach);
  config.feasibility.support_plane = options.support_plane;
  if (config.at_boundaries && grid.views().empty()) {
    throw Error(ErrorCode::invalid_argument,
                options.map + ": has no views, which boundary candidates need");
  }
  if (!config.at_boundaries) {
    config.sets.push_back(make_pose_set(
        options.generator, {center_of(options, grid), distance_of(options, sensor, grid),
                            options.count, options.seed, std::nullopt}));
  }
  return config;
}

// What the candidates gain, and their order: as proposed or, where a gain is asked for, best first.
struct Order {
  std::vector<std::size_t> order;  // of the candidates
  std::vector<ViewGain> gains;     // by candidate; empty where not asked for
  GainModel model = GainModel::paper;
};

Order rank(const Options& options, const SurfaceModel& model, const Sensor& sensor,
           const std::vector<Candidate>& candidates, const ExecConfig& exec) {
  Order ranking;
  ranking.order.resize(candidates.size());
  std::iota(ranking.order.begin(), ranking.order.end(), std::size_t{0});
  if (options.gain.empty()) return ranking;
  GainConfig config;
  config.model = ranking.model = parse_gain_model(options.gain);
  config.support_plane = options.support_plane;
  std::vector<Pose> poses;
  for (const Candidate& candidate : candidates) poses.push_back(candidate.T_world_camera);
  ranking.gains.resize(poses.size());
  GainEvaluator(model.scene(), sensor, config, exec).evaluate(poses, ranking.gains);
  // NaN last, ties as proposed.
  const auto worth = [&](std::size_t i) {
    const double gain = ranking.gains[i].gain;
    return std::isnan(gain) ? -std::numeric_limits<double>::infinity() : gain;
  };
  std::stable_sort(ranking.order.begin(), ranking.order.end(),
                   [&](std::size_t a, std::size_t b) { return worth(a) > worth(b); });
  return ranking;
}

nlohmann::ordered_json candidate_json(const Candidate& candidate, const EstimatedViews& estimated) {
  nlohmann::ordered_json json{{"generator", candidate.generator},
                              {"T_world_camera", to_json(candidate.T_world_camera)}};
  if (candidate.boundary_class) {
    const BoundaryCandidate& proposed = estimated.candidates[candidate.number.value()];
    const std::uint32_t patch = proposed.patch;
    json["class"] = boundary_class_name(proposed.boundary_class);
    json["run"] = proposed.run;
    json["patch"] = patch;
    json["region_vertices"] = estimated.regions[patch].size();
    json["patch_planar"] = estimated.patches[patch].planar;
    json["patch_rms"] = estimated.patches[patch].rms;
  }
  return json;
}

// A file without a pose would be of no use to anybody.
void refuse_none(const Options& options, const Proposal& proposal) {
  if (!proposal.candidates.empty()) return;
  const std::string reasons =
      proposal.dropped.empty() ? "" : "; dropped: " + counts_text(proposal.dropped);
  throw Error(ErrorCode::invalid_argument, options.map + ": no candidate of --generator " +
                                               options.generator + " is feasible" + reasons +
                                               "; no poses are written");
}

void candidates(const Options& options) {
  check(options);
  const ExecConfig exec{options.common.threads};
  const bool by_hazard =
      !options.gain.empty() && parse_gain_model(options.gain) != GainModel::paper;
  if (!by_hazard && (options.object_size || !options.hazard.empty())) {
    throw Error(ErrorCode::invalid_argument,
                "--object-size and --hazard go with --gain surface or combined");
  }
  auto [grid, sensor] = load_sensed_map(options.map, options.sensor);
  if (!options.body.empty()) sensor.body_size = parse_size("--body", options.body);
  const GenerationConfig config = generation_config(options, sensor, grid);

  SurfaceModelConfig model_config;
  model_config.map.hazard = hazard_source(options.hazard, options.object_size, grid);
  model_config.map.obstacles = obstacles_of(options.obstacles);
  const SurfaceModel model(std::move(grid), sensor, model_config, exec);
  CandidateGeneration generation(model, sensor, config, exec);
  const Proposal proposal = generation.generate({});
  const Order ranking = rank(options, model, sensor, proposal.candidates, exec);
  std::vector<Pose> poses;
  for (const std::size_t i : ranking.order) {
    poses.push_back(proposal.candidates[i].T_world_camera);
  }
  if (!poses.empty()) write_tum(options.out, poses);

  const EstimatedViews& estimated = generation.estimated();
  if (options.common.json) {
    nlohmann::ordered_json json{{"generator", options.generator},
                                {"candidates", poses.size()},
                                {"gain_model", nullptr},
                                {"gain_unit", nullptr},
                                {"dropped", nlohmann::ordered_json::object()},
                                {"runs", nlohmann::ordered_json::array()},
                                {"per_candidate", nlohmann::ordered_json::array()},
                                {"per_dropped", nlohmann::ordered_json::array()},
                                {"out", options.out}};
    if (!ranking.gains.empty()) {
      json["gain_model"] = gain_model_name(ranking.model);
      json["gain_unit"] = gain_unit(ranking.model, kCriterion);
    }
    for (const auto& [reason, count] : proposal.dropped) json["dropped"][reason] = count;
    for (const BoundaryRun& run : estimated.runs) {
      json["runs"].push_back({{"class", boundary_class_name(run.boundary_class)},
                              {"length", run.length},
                              {"closed", run.closed},
                              {"view", run.view}});
    }
    for (const std::size_t i : ranking.order) {
      json["per_candidate"].push_back(candidate_json(proposal.candidates[i], estimated));
      if (ranking.gains.empty()) continue;
      json["per_candidate"].back()["gain"] = ranking.gains[i].gain;
      json["per_candidate"].back()["area"] = ranking.gains[i].area;
    }
    for (const DroppedCandidate& dropped : generation.dropped()) {
      json["per_dropped"].push_back(candidate_json(dropped.candidate, estimated));
      json["per_dropped"].back()["reason"] = dropped.reason;
    }
    print_json(json);
    return refuse_none(options, proposal);
  }
  refuse_none(options, proposal);
  std::map<BoundaryClass, std::size_t> classes;
  for (const Candidate& candidate : proposal.candidates) {
    if (candidate.boundary_class) ++classes[*candidate.boundary_class];
  }
  std::printf("%zu candidates (%s)", poses.size(), options.generator.c_str());
  for (const auto& [boundary_class, count] : classes) {
    std::printf(", %zu %s", count, boundary_class_name(boundary_class).data());
  }
  std::printf("\n");
  for (const auto& [reason, count] : proposal.dropped) {
    std::printf("dropped: %zu %s\n", count, reason.c_str());
  }
  if (!ranking.gains.empty()) {
    std::printf("best first by the %s gain: %.6g %s\n",
                std::string(gain_model_name(ranking.model)).c_str(),
                ranking.gains[ranking.order.front()].gain,
                std::string(gain_unit(ranking.model, kCriterion)).c_str());
  }
  std::printf("poses in %s\n", options.out.c_str());
}

}  // namespace

Command add_candidates(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand(
      "candidates",
      "Candidate views for a map, as a poses file for score; --json says for each why it exists or "
      "why it was dropped.");
  Options& o = *options;
  const EstimatorConfig usual = default_estimator(1.0);
  app->add_option("MAP", o.map, kMapHelp)->required();
  one_of(*app->add_option("--generator", o.generator,
                          "boundary (open boundaries of the surface in the map), sphere, dome, "
                          "rings, shell or sequence")
              ->required(),
         generator_names(), "generator");
  app->add_option("--sensor", o.sensor, kMapSensorHelp);
  app->add_option("--count", o.count,
                  "poses of the sphere, dome or shell (default 500); rings: 48, 80, 288 or 864 "
                  "(default 48)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}, "count"));
  app->add_option("--distance", o.distance,
                  "boundary: from the surface; else from the centre [m]; default: the sensor's "
                  "working distance; the workspace fills the view");
  app->add_option("--center", o.center,
                  "x,y,z that poses look at, world [m]; default: the workspace's centre");
  app->add_option("--reach", o.reach, "TOML file: boxes, shells, half-spaces, poses in reach");
  app->add_option("--body", o.body, kBodyHelp);
  app->add_option("--support-plane", o.support_plane, "height z of a table [m]");
  app->add_option("--obstacle", o.obstacles, kObstacleHelp)->allow_extra_args(false);
  app->add_option("--overlap", o.overlap,
                  std::string(kOverlapHelp) + "; default: " + short_text(usual.overlap));
  app->add_option("--region-depth", o.region_depth,
                  std::string(kRegionDepthHelp) + "; default: " + short_text(usual.region_depth));
  one_of(*app->add_option(
             "--gain", o.gain,
             "paper, surface or combined, as in score: order the poses by it, best first"),
         gain_model_names(), "gain");
  app->add_option("--object-size", o.object_size, kObjectSizeHelp);
  app->add_option("--hazard", o.hazard, kHazardHelp);
  add_seed_option(*app, o.seed, "of the shell");
  app->add_option("--out", o.out, "TUM file of camera-to-world poses")->required();
  add_common_options(*app, o.common);
  add_help(*app, kViewsGroup,
           "candidates map.vdb --generator boundary --sensor sr4000 --out poses.txt");
  return {app, [options] { candidates(*options); }};
}

}  // namespace viewgain::app
