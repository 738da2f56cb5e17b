// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/json.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "program/commands/frames/mask_use.hpp"
#include "program/commands/map_json.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string source;  // MAP or FRAMES_DIR
  FrameMapOptions frames;
  ProposalOptions proposal;
  std::size_t top = 10;
  std::string out;
  bool explain = false;
};

// What a folder of frames leaves beside its map.
struct Frames {
  FrameCounts counts;
  std::vector<Pose> tried;
  std::optional<Pose> last_pose;
  Obstacles obstacles;
  std::uint64_t masked_pixels = 0;
  Json contradiction{};
};

SensedMap map_of(const Options& options, const ExecConfig& exec, std::optional<Frames>& frames) {
  if (options.frames.folder.folder.empty()) {
    SensedMap map =
        load_sensed_map(options.source, options.frames.folder.sensor, exec_of(options.common));
    require_known(map.grid, options.source);
    return {std::move(map.grid), with_body(std::move(map.sensor), options.proposal)};
  }
  check_contradiction(options.frames.folder, false);
  FrameMap map(options.frames, options.proposal, options.common.quiet, exec);
  Progress progress("frame", options.common.quiet);
  for (std::size_t i = 0; i < map.folder().size(); ++i) {
    map.add(i);
    progress.update(i + 1, map.folder().size());
  }
  map.require_frames(true);
  frames = {map.counts(),           map.tried(),         map.last_pose(),
            map.config().obstacles, map.masked_pixels(), map.consistency_json()};
  return {map.scorer().grid().clone(), map.scorer().sensor()};
}

void next(const Options& options) {
  const Stopwatch watch;
  check(options.proposal);
  const ExecConfig exec = exec_of(options.common);
  std::optional<Frames> frames;
  auto [grid, sensor] = map_of(options, exec, frames);
  const GenerationConfig config = generation_config(options.proposal, sensor, grid, options.source,
                                                    frames ? frames->tried : std::vector<Pose>());
  const Obstacles obstacles = frames ? frames->obstacles : obstacles_of(options.proposal.obstacles);
  const SurfaceModel model = model_of(std::move(grid), sensor, options.proposal, obstacles, exec);
  if (!frames) warn_of_set_up(options.proposal, obstacles, model.grid(), sensor);
  warn_of_views(options.proposal, obstacles, model, sensor);
  CandidateGeneration generation(model, config, exec);
  const Proposal proposal = generation.generate({});
  const GainEvaluator evaluator = evaluator_of(options.proposal, model, sensor, exec);
  NextViews views = best_views(evaluator, proposal, options.proposal,
                               frames ? frames->last_pose : last_view(model.grid()), options.top,
                               options.common.quiet);
  if (options.explain) explain(views, proposal, evaluator);
  if (!options.out.empty()) save_poses(options.out, poses_of(views));
  if (options.common.json) {
    Json json{{"views", model.grid().views().size()}};
    if (frames) {
      json.update(map_json(model.grid(), model.grid().statistics()));
      json.update(frames_json(frames->counts));
      json["contradiction"] = frames->contradiction;
    }
    json.update(to_json(views));
    json["out"] = nullptr;
    if (!options.out.empty()) json["out"] = options.out;
    json["seconds"] = watch.seconds();
    print_json(json);
    return;
  }
  if (frames) print_map(model.grid(), model.grid().statistics());
  std::printf("%zu views so far, %s; %s\n", model.grid().views().size(),
              printable(sensor.name).c_str(), summary_of(views).c_str());
  if (const std::string text = frames ? frames_text(frames->counts) : ""; !text.empty()) {
    std::printf("%s\n", text.c_str());
  }
  if (frames) {
    std::printf("%s", masked_text(options.frames.folder, frames->masked_pixels).c_str());
  }
  std::printf("%s", text_of(views).c_str());
  if (!options.out.empty()) std::printf("poses in %s\n", options.out.c_str());
}

void add_options(App& app, Options& o) {
  add_next_view_options(app, o.proposal, o.top);
  app.add_option(
      "--out", o.out,
      "file of camera-to-world poses to write (.txt or .tum: TUM text; .npy), best first, or in "
      "the plan's order");
  app.add_flag("--explain", o.explain,
               "say of each view what becomes of its rays: how many come to unknown space, end in "
               "known surface, leave the map, ...; where no view gains, of all candidates'");
  add_trace_option(app, o.common);
  add_common_options(app, o.common);
}

Command add_next_of_frames() {
  auto options = std::make_shared<Options>();
  const auto own =
      app_of_frames("next", "The same for a folder of frames, which go into a map first.");
  App* app = own.get();
  add_frame_map_options(*app, options->frames);
  add_options(*app, *options);
  add_help(*app, kViewsGroup, "next frames --voxel 0.01 --top 3");
  return {app,
          [options] {
            options->source = options->frames.folder.folder;
            next(*options);
          },
          nullptr, own};
}

}  // namespace

Command add_next(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "next",
      "Where the camera should look next: the best views for a map, each with its gain and why it "
      "was proposed. It names none where nothing that the camera can reach is left to gain.");
  app->add_option("MAP", options->source, kMapHelp)->required();
  app->add_option("--sensor", options->frames.folder.sensor, kMapSensorHelp);
  add_options(*app, *options);
  add_help(*app, kViewsGroup, "next map.vdb --sensor sr4000 --top 3 --out next.txt");
  return {app, [options] { next(*options); }, std::make_shared<Command>(add_next_of_frames())};
}

}  // namespace viewgain::app
