// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

// Why a candidate at a boundary exists.
void put_boundary(Json& json, const Candidate& candidate, const EstimatedViews& estimated) {
  if (!candidate.boundary_class) return;
  const BoundaryCandidate& proposed = estimated.candidates[candidate.number.value()];
  json["class"] = boundary_class_name(proposed.boundary_class);
  json["run"] = proposed.run;
  json["patch"] = proposed.patch;
  json["region_vertices"] = estimated.regions[proposed.patch].size();
  json["patch_planar"] = estimated.patches[proposed.patch].planar;
  json["patch_rms"] = estimated.patches[proposed.patch].rms;
}

// With --top all, also writes the boundaries, and each dropped candidate with its reason.
void put_all(Json& json, const NextViews& views, const Proposal& proposal,
             const CandidateGeneration& generation) {
  const EstimatedViews& estimated = generation.estimated();
  for (std::size_t i = 0; i < views.views.size(); ++i) {
    put_boundary(json["next"][i], proposal.candidates[views.views[i].index], estimated);
  }
  json["runs"] = Json::array();
  for (const BoundaryRun& run : estimated.runs) {
    json["runs"].push_back({{"class", boundary_class_name(run.boundary_class)},
                            {"length", run.length},
                            {"closed", run.closed},
                            {"view", run.view}});
  }
  json["per_dropped"] = Json::array();
  for (const DroppedCandidate& dropped : generation.dropped()) {
    const Candidate& candidate = dropped.candidate;
    Json one{{"generator", candidate.generator},
             {"T_world_camera", to_json(candidate.T_world_camera)},
             {"reason", dropped.reason}};
    put_boundary(one, candidate, estimated);
    json["per_dropped"].push_back(std::move(one));
  }
}

// Number of views; empty for "all".
std::optional<std::size_t> parse_top(const std::string& text) {
  if (text == "all") return std::nullopt;
  const std::size_t count = parse_count("--top", parse_numbers("--top", text, 1, 1)[0]);
  if (count < 1) refuse("--top 0: the value must be at least 1, or all");
  return count;
}

struct Options {
  CommonOptions common;
  std::string map;
  std::string sensor;
  ProposalOptions proposal;
  std::string top = "10";
  std::string out;
  bool explain = false;
};

void check(const Options& options) {
  check(options.proposal);
  if (parse_top(options.top)) return;
  if (options.explain) refuse("--explain cannot be used with --top all");
  if (parse_plan(options.proposal.plan).is_on()) refuse("--plan cannot be used with --top all");
}

void next(const Options& options) {
  const Stopwatch watch;
  check(options);
  const std::optional<std::size_t> top = parse_top(options.top);
  const ExecConfig exec = exec_of(options.common);
  SensedMap map = load_sensed_map(options.map, options.sensor, exec);
  require_known(map.grid, options.map);
  const Sensor sensor = with_body(std::move(map.sensor), options.proposal);
  const GenerationConfig config =
      generation_config(options.proposal, sensor, map.grid, options.map);
  const Obstacles obstacles = obstacles_of(options.proposal.obstacles);
  const SurfaceModel model =
      model_of(std::move(map.grid), sensor, options.proposal, obstacles, exec);
  warn_of_set_up(options.proposal, obstacles, model.grid(), sensor);
  warn_of_views(options.proposal, obstacles, model, sensor);
  CandidateGeneration generation(model, config, exec);
  const Proposal proposal = generation.generate({});
  const GainEvaluator evaluator = evaluator_of(options.proposal, model, sensor, exec);
  const std::optional<Pose> last = last_view(model.grid());
  NextViews views =
      top ? best_views(evaluator, proposal, options.proposal, last, *top, options.common.quiet)
          : all_views(evaluator, proposal, options.proposal, last, options.common.quiet);
  if (options.explain) explain(views, proposal, evaluator);
  if (!options.out.empty()) save_poses(options.out, poses_of(views));
  if (options.common.json) {
    Json json{{"views", model.grid().views().size()}};
    json.update(to_json(views));
    if (!top) put_all(json, views, proposal, generation);
    json["out"] = nullptr;
    if (!options.out.empty()) json["out"] = options.out;
    json["seconds"] = watch.seconds();
    print_json(json);
    return;
  }
  std::printf("%zu views so far; %s; %s\n", model.grid().views().size(),
              printable(sensor.name).c_str(), summary_of(views).c_str());
  std::printf("%s", text_of(views).c_str());
  if (options.proposal.reach.empty()) {
    std::printf("%s", outside_text(views, model.grid()).c_str());
  }
  if (!options.out.empty()) std::printf("poses written to %s\n", options.out.c_str());
}

}  // namespace

Command add_next(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "next",
      "Propose the next-best views for a map. Print each view's gain and the source of candidates "
      "that it comes from. If no reachable view has a positive gain, the list is empty.");
  Options& o = *options;
  app->add_option("MAP", o.map, kMapHelp)->required();
  app->add_option("--sensor", o.sensor, kMapSensorHelp);
  add_next_view_options(*app, o.proposal);
  app->add_option("--top", o.top,
                  "maximum number of views, each with its marginal gain; all: list all possible "
                  "candidates, each with the gain of this view alone");
  app->add_option("--out", o.out,
                  "file for the camera-to-world poses of the views (.txt, .tum or .npy), best "
                  "first or, with --plan, in the order of the plan");
  app->add_flag(
      "--explain", o.explain,
      "print where the rays of each view end; if no view has a gain, print this for up to 32 "
      "candidates together (cannot be used with --top all)");
  most_need(*app, {"--top", "--out", "--sensor", "--generator", "--poses", "--gain", "--reach",
                   "--obstacle", "--plan", "--explain"});
  add_help(*app, kViewsGroup, "next map.vdb --sensor sr4000 --top 3 --out next.txt");
  return command_of(app, options, next);
}

}  // namespace viewgain::app
