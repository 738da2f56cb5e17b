// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
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
#include "viewgain/formats/map_file.hpp"
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

// With --top all also the boundaries, and each candidate that was dropped with its reason.
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

struct Options {
  CommonOptions common;
  std::string map;
  std::string sensor;
  ProposalOptions proposal;
  std::string top = "10";
  std::string out;
  bool explain = false;

  [[nodiscard]] bool all() const { return top == "all"; }
};

void check(const Options& options) {
  check(options.proposal);
  if (!options.all()) return;
  if (options.explain) refuse("--explain goes with --top N, not all");
  if (parse_plan(options.proposal.plan).is_on()) refuse("--plan goes with --top N, not all");
}

void next(const Options& options) {
  const Stopwatch watch;
  check(options);
  if (std::error_code ignored; std::filesystem::is_directory(options.map, ignored) &&
                               !std::filesystem::exists(map_in(options.map), ignored)) {
    refuse(options.map + ": has no map.vdb or state.vdb; frames become a map by viewgain model " +
           options.map + " --out RUN");
  }
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
      options.all()
          ? all_views(evaluator, proposal, options.proposal, last, options.common.quiet)
          : best_views(evaluator, proposal, options.proposal, last,
                       static_cast<std::size_t>(std::stoul(options.top)), options.common.quiet);
  if (options.explain) explain(views, proposal, evaluator);
  if (!options.out.empty()) save_poses(options.out, poses_of(views));
  if (options.common.json) {
    Json json{{"views", model.grid().views().size()}};
    json.update(to_json(views));
    if (options.all()) put_all(json, views, proposal, generation);
    json["out"] = nullptr;
    if (!options.out.empty()) json["out"] = options.out;
    json["seconds"] = watch.seconds();
    print_json(json);
    return;
  }
  std::printf("%zu views so far, %s; %s\n", model.grid().views().size(),
              printable(sensor.name).c_str(), summary_of(views).c_str());
  std::printf("%s", text_of(views).c_str());
  if (!options.out.empty()) std::printf("poses in %s\n", options.out.c_str());
}

CLI::Validator count_or_all() {
  return {[number = counted(1, 1'000'000)](std::string& value) {
            return value == "all" ? std::string() : number(value);
          },
          "COUNT or all"};
}

}  // namespace

Command add_next(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "next",
      "Where the camera should look next: the best views for a map, each with its gain and why it "
      "was proposed. It names none where nothing that the camera can reach is left to gain.");
  Options& o = *options;
  app->add_option("MAP", o.map, kMapHelp)->required();
  app->add_option("--sensor", o.sensor, kMapSensorHelp);
  add_next_view_options(*app, o.proposal);
  app->add_option("--top", o.top,
                  "views to name at most, each by what it adds to those before it, so that no two "
                  "show the same; all: every possible candidate by its own gain, best first, and "
                  "with --json why the others were dropped")
      ->check(count_or_all());
  app->add_option(
      "--out", o.out,
      "file of camera-to-world poses to write (.txt or .tum: TUM text; .npy), best first, or in "
      "the plan's order");
  app->add_flag("--explain", o.explain,
                "say of each view what becomes of its rays: how many come to unknown space, end in "
                "known surface, leave the map, ...; where no view gains, of all candidates'");
  most_need(*app, {"--top", "--out", "--sensor", "--generator", "--poses", "--gain", "--reach",
                   "--obstacle", "--plan", "--explain"});
  add_help(*app, kViewsGroup, "next map.vdb --sensor sr4000 --top 3 --out next.txt");
  return command_of(app, options, next);
}

}  // namespace viewgain::app
