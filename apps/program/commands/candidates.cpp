// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {
namespace {

constexpr std::string_view kCriterion = "log_diagonal";  // of all gains here

struct Options {
  CommonOptions common;
  std::string map;
  std::string sensor;
  ProposalOptions proposal;
  std::string out;
};

// What the candidates gain, and their order: as proposed or, where a gain is asked for, best first.
struct Order {
  std::vector<std::size_t> order;  // of the candidates
  std::vector<ViewGain> gains;     // by candidate; empty where not asked for
  GainModel model = kDefaultGain;
};

Order rank(const ProposalOptions& options, const SurfaceModel& model, const Sensor& sensor,
           const ExecConfig& exec, const std::vector<Candidate>& candidates) {
  Order ranking;
  ranking.order.resize(candidates.size());
  std::iota(ranking.order.begin(), ranking.order.end(), std::size_t{0});
  if (options.gain.empty()) return ranking;
  const GainEvaluator evaluator = evaluator_of(options, model, sensor, exec);
  ranking.model = evaluator.model();
  ranking.gains.resize(candidates.size());
  ranking.order.clear();
  const std::vector<Pose> poses = poses_of(candidates);
  for (const RankedView& view : rank_views(evaluator, poses, poses.size(), {.exact = true}).views) {
    ranking.order.push_back(view.index);
    ranking.gains[view.index] = view.gain;
  }
  return ranking;
}

Json candidate_json(const Candidate& candidate, const EstimatedViews& estimated) {
  Json json{{"generator", candidate.generator},
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
  refuse(options.map + ": no candidate of --generator " + options.proposal.generator +
         " is feasible" + reasons + "; no poses are written");
}

void candidates(const Options& options) {
  check(options.proposal);
  const ExecConfig exec = exec_of(options.common);
  SensedMap map = load_sensed_map(options.map, options.sensor, exec);
  require_known(map.grid, options.map);
  const Sensor sensor = with_body(std::move(map.sensor), options.proposal);
  const GenerationConfig config =
      generation_config(options.proposal, sensor, map.grid, options.map);
  const Obstacles obstacles = obstacles_of(options.proposal.obstacles);
  warn_of_set_up(options.proposal, obstacles, map.grid, sensor);
  const SurfaceModel model =
      model_of(std::move(map.grid), sensor, options.proposal, obstacles, exec);
  warn_of_views(options.proposal, obstacles, model, sensor);
  CandidateGeneration generation(model, config, exec);
  const Proposal proposal = generation.generate({});
  const Order ranking = rank(options.proposal, model, sensor, exec, proposal.candidates);
  std::vector<Pose> poses;
  for (const std::size_t i : ranking.order) poses.push_back(proposal.candidates[i].T_world_camera);
  if (!poses.empty()) save_poses(options.out, poses);

  const EstimatedViews& estimated = generation.estimated();
  if (options.common.json) {
    Json json{{"generator", options.proposal.generator},
              {"candidates", poses.size()},
              {"gain_model", nullptr},
              {"gain_unit", nullptr},
              {"dropped", Json::object()},
              {"runs", Json::array()},
              {"per_candidate", Json::array()},
              {"per_dropped", Json::array()},
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
  std::printf("%zu candidates (%s)", poses.size(), options.proposal.generator.c_str());
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

Command add_candidates(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "candidates",
      "Candidate views for a map, as a poses file for score; --json says for each why it exists or "
      "why it was dropped.");
  Options& o = *options;
  app->add_option("MAP", o.map, kMapHelp)->required();
  app->add_option("--generator", o.proposal.generator,
                  "boundary (open boundaries of the surface in the map, and where more of it is "
                  "expected), sphere, dome, rings, shell or sequence")
      ->required()
      ->check(one_of(generator_names(), "generator"));
  app->add_option("--sensor", o.sensor, kMapSensorHelp);
  add_proposal_options(*app, o.proposal);
  app->add_option("--gain", o.proposal.gain,
                  "paper, surface or combined, as in score: order the poses by it, best first")
      ->check(one_of_gain_models());
  app->add_option("--out", o.out,
                  "file of camera-to-world poses to write (.txt or .tum: TUM text; .npy)")
      ->required();
  add_trace_option(*app, o.common);
  add_common_options(*app, o.common);
  add_help(*app, kViewsGroup,
           "candidates map.vdb --generator boundary --sensor sr4000 --out poses.txt");
  return {app, [options] { candidates(*options); }};
}

}  // namespace viewgain::app
