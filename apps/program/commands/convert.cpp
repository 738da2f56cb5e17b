// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/map_json.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string in;
  std::string out;
  std::string workspace, sensor;
  std::optional<double> prior_sigma;
};

void check(const Options& options) {
  const auto refuse = [](const std::string& flag, const std::string& file, const char* why) {
    app::refuse(flag + " with " + file + ": " + why);
  };
  if (!is_octomap(options.in)) {
    constexpr const char* kWhy = "a .vdb map has its own; the flag is for .ot and .bt";
    if (!options.workspace.empty()) refuse("--workspace", options.in, kWhy);
    if (options.prior_sigma) refuse("--prior-sigma", options.in, kWhy);
    if (!options.sensor.empty()) refuse("--sensor", options.in, kWhy);
  }
  check_map_name(options.out);
}

void convert(const Options& options) {
  const Stopwatch watch;
  check(options);
  OctomapConfig config;
  if (!options.workspace.empty()) config.workspace = parse_box("--workspace", options.workspace);
  config.prior_sigma = options.prior_sigma;
  std::optional<Sensor> sensor;
  if (!options.sensor.empty()) sensor = load_sensor(options.sensor);
  const BeliefGrid grid =
      load_map(options.in, sensor ? &*sensor : nullptr, config, exec_of(options.common));
  const LostInTree lost = save_map(grid, options.out, {true});
  warn_of_lost_frame(lost, options.out);
  const BeliefGrid::Statistics statistics = grid.statistics();
  if (options.common.json) {
    Json json = {{"in", options.in}, {"out", options.out}};
    json.update(map_json(grid, statistics));
    json.update({{"lost_beliefs", lost.beliefs},
                 {"lost_views", lost.views},
                 {"lost_hazard_counters", lost.hazard_counters},
                 {"lost_T_world_grid", lost.T_world_grid},
                 {"hash", grid.content_hash()},
                 {"seconds", watch.seconds()}});
    print_json(json);
    return;
  }
  print_map(grid, statistics);
  if (lost.beliefs > 0 || lost.views > 0) {
    std::printf("not stored in the tree: beliefs of %s voxels, %s views%s\n",
                with_commas(lost.beliefs).c_str(), with_commas(lost.views).c_str(),
                lost.hazard_counters ? ", counts behind learned hazards" : "");
  }
  std::printf("%s\n", options.out.c_str());
}

}  // namespace

Command add_convert(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "convert",
      "Convert a map between .vdb and the OctoMap formats .ot and .bt. A .bt file can only be "
      "read. An .ot file holds voxel states and log-odds; beliefs, prior and views are lost. It "
      "keeps the map's pose T_world_grid only if this is a shift by whole voxels; otherwise the "
      "pose is lost, with a warning. A .vdb file also gets covariances and mean positions for "
      "viewers.");
  app->add_option("IN", options->in, kMapHelp)->required();
  app->add_option("OUT", options->out, "map to write (.vdb or .ot)")->required();
  app->add_option("--workspace", options->workspace,
                  "x0,y0,z0,x1,y1,z1: part of an OctoMap tree to convert [m] (default: all of its "
                  "known voxels)");
  app->add_option("--prior-sigma", options->prior_sigma,
                  "standard deviation of an unknown voxel of an OctoMap tree [m] (default: from "
                  "--sensor, else voxel/2)");
  app->add_option(
      "--sensor", options->sensor,
      std::string("sensor that determines the default of --prior-sigma: ") + kSensorHelp);
  add_help(*app, kLookGroup, "convert map.vdb tree.ot");
  return command_of(app, options, convert);
}

}  // namespace viewgain::app
