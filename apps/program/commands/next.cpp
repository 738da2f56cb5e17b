// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "program/cli/choices.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/sensed_map.hpp"
#include "program/cli/json_text.hpp"
#include "program/cli/progress.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string source;  // MAP
  FrameMapOptions frames;
  ProposalOptions proposal;
  std::size_t top = 10;
  std::string out;
};

SensedMap map_of(const Options& options, const App& app, const ExecConfig& exec) {
  if (!is_frame_folder(options.source)) {
    refuse_frame_map_options(app, "is for a folder of frames, not for a map");
    SensedMap map = load_sensed_map(options.source, options.frames.folder.sensor);
    return {std::move(map.grid), with_body(std::move(map.sensor), options.proposal)};
  }
  FrameMapOptions frames = options.frames;
  frames.folder.folder = options.source;
  FrameMap map(frames, options.proposal, options.common.quiet, exec);
  Progress progress("frame", options.common.quiet);
  for (std::size_t i = 0; i < map.folder().size(); ++i) {
    map.add(i);
    progress.update(i + 1, map.folder().size());
  }
  map.require_readings();
  return {map.model().grid().clone(), map.model().sensor()};
}

void next(const Options& options, const App& app) {
  const Stopwatch watch;
  check(options.proposal);
  const ExecConfig exec{options.common.threads};
  auto [grid, sensor] = map_of(options, app, exec);
  const GenerationConfig config = generation_config(options.proposal, sensor, grid, options.source);
  const SurfaceModel model = model_of(std::move(grid), sensor, options.proposal, exec);
  CandidateGeneration generation(model, sensor, config, exec);
  const Proposal proposal = generation.generate({});
  const GainEvaluator evaluator = evaluator_of(options.proposal, model, sensor, exec);
  const NextViews views = best_views(evaluator, proposal, options.top);
  if (!options.out.empty()) write_tum(options.out, poses_of(views));
  if (options.common.json) {
    Json json{{"views", model.grid().views().size()}};
    json.update(to_json(views));
    json["out"] = nullptr;
    if (!options.out.empty()) json["out"] = options.out;
    json["seconds"] = watch.seconds();
    print_json(json);
    return;
  }
  std::printf("%zu views so far, %s; %s\n", model.grid().views().size(), sensor.name.c_str(),
              summary_of(views).c_str());
  std::printf("%s", text_of(views).c_str());
  if (!options.out.empty()) std::printf("poses in %s\n", options.out.c_str());
}

}  // namespace

Command add_next(App& program) {
  auto options = std::make_shared<Options>();
  options->proposal.gain = "combined";
  App* app = program.add_subcommand(
      "next",
      "Where the camera should look next: the best views for a map, or for a folder of frames, "
      "each with its gain and why it was proposed. None is an answer, too: nothing is left to "
      "gain that the camera can reach.");
  Options& o = *options;
  app->add_option("MAP", o.source,
                  std::string(kMapHelp) +
                      ", or a folder of frames as integrate "
                      "takes it")
      ->required();
  app->add_option("--sensor", o.frames.folder.sensor, kMapSensorHelp);
  add_frame_map_options(*app, o.frames);
  one_of(*app->add_option("--generator", o.proposal.generator,
                          "where views come from: boundary (open boundaries of the surface in the "
                          "map), sphere, dome, rings, shell or sequence")
              ->capture_default_str(),
         generator_names(), "generator");
  add_proposal_options(*app, o.proposal);
  one_of(*app->add_option("--gain", o.proposal.gain, "paper, surface or combined, as in score")
              ->capture_default_str(),
         gain_model_names(), "gain");
  app->add_option("--top", o.top, "views to name at most")
      ->capture_default_str()
      ->range(std::size_t{1}, std::size_t{1'000'000}, "count");
  app->add_option("--out", o.out, "TUM file of camera-to-world poses to write, best first");
  add_common_options(*app, o.common);
  add_help(*app, kViewsGroup, "next map.vdb --sensor sr4000 --top 3 --out next.txt");
  return {app, [options, app] { next(*options, *app); }};
}

}  // namespace viewgain::app
