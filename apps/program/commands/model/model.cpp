// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "program/cli/flags/stop_rules.hpp"
#include "program/cli/help.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/model/model_options.hpp"

namespace viewgain::app {

void add_model_options(App& app, ModelOptions& o) {
  add_frame_map_options(app, o.frames);
  add_registration_option(app, o.registration);
  add_next_view_options(app, o.proposal);
  app.add_option("--top", o.top,
                 "views to name at most, each by what it adds to those before it, so that no two "
                 "show the same; with --plan that has the numbers")
      ->check(counted(1, 1'000'000));
  add_output_options(app, o.outputs);
  begin_group(app, "Frames that are still to come");
  Option* watch = app.add_flag(
      "--watch", o.watch,
      "wait for more frames until a signal, or until FRAMES_DIR/done is there; after each frame "
      "OUT has state.vdb, next.txt and next.json; the same call goes on, also after a kill");
  app.add_option("--max-views", o.max_views, "view budget: a reason to stop")
      ->check(counted(1, 1'000'000))
      ->needs(watch);
  add_stop_option(app, o.stop);
  app.get_option("--stop")->needs(watch);
  for (const char* name :
       {"--costs", "--from", "--save-maps", "--pictures", "--report", "--resume"}) {
    watch->excludes(app.get_option(name));
  }
  most_need(app, {"--voxel", "--workspace", "--out", "--sensor", "--top", "--reach", "--register",
                  "--support-plane", "--watch", "--report"});
  add_help(app, kLoopGroup, "model frames --voxel 0.01 --pictures off --out run_of_frames");
}

Command add_model(App& program) {
  auto options = std::make_shared<ModelOptions>();
  App* app = program.add_subcommand(
      "model",
      "A folder of depth frames into a map, its surface, its points, and the views to take next. "
      "With --watch also of frames that are still to come, beside the program that writes them.");
  add_model_options(*app, *options);
  return command_of(app, options, [app](const ModelOptions& given) {
    given.watch ? model_arriving_frames(given) : model_recorded_frames(given, *app);
  });
}

}  // namespace viewgain::app
