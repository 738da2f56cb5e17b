// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "program/cli/flags/stop_rules.hpp"
#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/model/model_options.hpp"

namespace viewgain::app {

void add_model_options(App& app, ModelOptions& o) {
  add_frame_map_options(app, o.frames);
  add_registration_option(app, o.registration);
  add_next_view_options(app, o.proposal);
  app.add_option(
         "--top", o.top,
         "maximum number of views to propose, each with its marginal gain (with --plan K[,M], "
         "M views are proposed)")
      ->check(counted(1, 1'000'000));
  add_output_options(app, o.outputs);
  begin_group(app, "Watching a folder");
  Option* watch = app.add_flag(
      "--watch", o.watch,
      "process new frames until the file FRAMES_DIR/done exists or a signal arrives (requires "
      "--workspace; cannot be used with --costs, --from, --resume)");
  explain_values(app,
                 "With --watch:\n"
                 "  After each frame, the program writes state.vdb, next.txt and next.json to the\n"
                 "  folder of --out. next.json states when to stop (--max-views, --stop). If the\n"
                 "  program was killed, repeat the command to continue.\n"
                 "  --watch cannot be used with --pictures, --save-maps or --report.\n");
  app.add_option(
         "--max-views", o.max_views,
         "maximum number of views; when it is reached, the stop_reason in next.json is max_views "
         "(requires --watch)")
      ->check(counted(1, 1'000'000))
      ->needs(watch);
  add_stop_option(app, o.stop);
  app.get_option("--stop")->needs(watch);
  for (const char* name : {"--costs", "--from", "--resume"}) watch->excludes(app.get_option(name));
  most_need(app, {"--voxel", "--workspace", "--out", "--sensor", "--top", "--reach", "--register",
                  "--support-plane", "--watch", "--report"});
  add_help(app, kLoopGroup, "model frames --voxel 0.01 --pictures off --out run_of_frames");
}

Command add_model(App& program) {
  auto options = std::make_shared<ModelOptions>();
  App* app = program.add_subcommand(
      "model",
      "Build a map, a surface and a point cloud from a folder of depth frames, and propose the "
      "next views. With --watch, process frames while another program writes them.");
  add_model_options(*app, *options);
  return command_of(app, options, [app](const ModelOptions& given) {
    const RunOutputs& outputs = given.outputs;
    const bool draws = app->count("--pictures") > 0 && outputs.with_pictures();
    if (given.watch && (draws || outputs.saves_maps() || outputs.with_report())) {
      refuse("--watch cannot be used with --pictures, --save-maps or --report");
    }
    given.watch ? model_arriving_frames(given) : model_recorded_frames(given, *app);
  });
}

}  // namespace viewgain::app
