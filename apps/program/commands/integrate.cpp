// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/integrate.hpp"

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <utility>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/help.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/frames/frame_tally.hpp"
#include "program/commands/frames/mask_use.hpp"
#include "program/commands/frames/reading_source.hpp"
#include "program/commands/map_json.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

using Options = IntegrateOptions;

const char* part_name(const Options& options) { return options.clouds.empty() ? "frame" : "cloud"; }

std::optional<double> scale_of(const ReadingSource& source) {
  if (source.folder() == nullptr) return std::nullopt;
  return source.folder()->frames().depth_scale;
}

BeliefGrid new_map(ReadingSource& source, const Options& options) {
  if (!options.voxel) refuse("--voxel is required without --map");
  check_positive("--voxel", *options.voxel);
  GridConfig config;
  config.voxel_size = *options.voxel;
  config.prior_sigma = options.prior_sigma;
  config.workspace = options.workspace.empty()
                         ? source.seen_workspace(config.voxel_size, options.common.quiet)
                         : parse_box("--workspace", options.workspace);
  BeliefGrid grid(config, source.sensor());
  warn_of_few_voxels(grid);
  return grid;
}

// An existing map keeps its layout and prior; flags that contradict them are an error.
BeliefGrid continued_map(const Sensor& sensor, const Options& options) {
  OctomapConfig tree;  // which has no prior or workspace of its own
  tree.prior_sigma = options.prior_sigma;
  if (!options.workspace.empty()) tree.workspace = parse_box("--workspace", options.workspace);
  BeliefGrid grid = load_map(options.map, &sensor, tree, exec_of(options.common));
  warn_of_other_sensor(options.map, grid, sensor);
  const auto conflict = [&options](const std::string& flag, const std::string& given,
                                   const std::string& stored) {
    refuse(flag + " " + given + ": " + options.map + " has a different value, " + stored);
  };
  if (options.voxel && *options.voxel != grid.voxel_size()) {
    check_positive("--voxel", *options.voxel);
    conflict("--voxel", short_text(*options.voxel), short_text(grid.voxel_size()));
  }
  if (options.prior_sigma && *options.prior_sigma != grid.prior_sigma()) {
    conflict("--prior-sigma", short_text(*options.prior_sigma), short_text(grid.prior_sigma()));
  }
  if (!options.workspace.empty()) {
    const BeliefGrid asked({grid.voxel_size(), parse_box("--workspace", options.workspace),
                            grid.T_world_grid(), grid.prior_sigma()});
    if (asked.min_index() != grid.min_index() || asked.dims() != grid.dims()) {
      conflict("--workspace", options.workspace, describe(grid.workspace()));
    }
  }
  return grid;
}

// Empty for no values.
std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

struct Totals {
  explicit Totals(bool quiet) : tally(quiet) {}

  FrameTally tally;
  IntegrationReport sum{};
  std::uint64_t masked_pixels = 0;
  std::uint64_t jump_edge_removed = 0;
  std::size_t skipped = 0;                       // frames that the map already has
  std::vector<FrameRegistration> registrations;  // of the other frames, if these are registered
  std::optional<FrameConsistency> consistency;   // of depth frames
  std::vector<double> seconds;  // of each frame's integration, without reading the image
};

Totals integrate_all(ReadingSource& source, const Options& options) {
  Totals totals(options.common.quiet);
  Progress progress(part_name(options), options.common.quiet);
  for (std::size_t i = 0; i < source.size(); ++i) {
    FrameFault fault;
    const std::string identity = source.identity(i, fault);
    if (source.grid().notes().frames.contains(identity)) {
      ++totals.skipped;
      progress.update(i + 1, source.size());
      continue;
    }
    if (fault.verdict == FrameVerdict::used) fault = source.load(i);
    if (fault.verdict == FrameVerdict::used) {
      if (std::optional<FrameRegistration> registration = source.register_loaded()) {
        if (leaves_out(*registration, options.frames.on_contradiction)) {
          fault = {FrameVerdict::contradicts,
                   source.file(i).string() + ": " + registration->reason};
        }
        totals.registrations.push_back(std::move(*registration));
      }
    }
    if (fault.verdict == FrameVerdict::used) {
      const Stopwatch watch;
      const MapUpdate update = source.integrate();
      fault.verdict = update.verdict;
      totals.tally.add(update.counts);
      if (is_in_map(update.verdict)) {
        totals.seconds.push_back(watch.seconds());
        totals.masked_pixels += source.masked_pixels();
      }
      totals.jump_edge_removed += update.flying_pixels;
      totals.sum += update.counts;
    }
    totals.tally.add(source.file(i), fault);
    progress.update(i + 1, source.size());
  }
  totals.consistency = source.consistency();
  return totals;
}

void print_summary(const Options& options, const ReadingSource& source, const BeliefGrid& grid,
                   const Totals& totals, const LostInTree& lost, double seconds) {
  const BeliefGrid::Statistics statistics = grid.statistics();
  const std::size_t taken = totals.seconds.size();
  const std::optional<double> frame_seconds = median(totals.seconds);
  if (options.common.json) {
    const std::optional<double> scale = scale_of(source);
    Json json = {{part_name(options) + std::string("s"), taken},
                 {"carved", nullptr},
                 {"bad", nullptr},
                 {"skipped", totals.skipped},
                 {"views", grid.views().size()},
                 {"readings", totals.sum.readings},
                 {"readings_inside", totals.sum.readings_inside},
                 {"plane_readings", totals.sum.plane_readings},
                 {"masked_pixels", totals.masked_pixels},
                 {"jump_edge_removed", totals.jump_edge_removed},
                 {"out_of_range", totals.sum.out_of_range},
                 {"invalid", totals.sum.invalid},
                 {"orthonormalized_poses", source.orthonormalized()},
                 {"registration", nullptr},
                 {"contradiction", nullptr},
                 {"sensor", source.sensor().name},
                 {"depth_scale", scale}};
    const Json frames = frames_json(totals.tally.counts());
    for (const char* key : {"carved", "bad"}) json[key] = frames[key];
    if (totals.consistency) {
      json["contradiction"] = to_json(*totals.consistency, totals.tally.numbers());
    }
    if (options.registration.is_on()) {
      json["registration"] = registration_counts(totals.registrations);
    }
    json.update(map_json(grid, statistics));
    json.update({{"lost_T_world_grid", lost.T_world_grid},
                 {"hash", grid.content_hash()},
                 {"out", options.out},
                 {"seconds", seconds},
                 {"seconds_per_frame", frame_seconds}});
    print_json(json);
    return;
  }
  print_map(grid, statistics);
  if (const auto scale = scale_of(source)) {
    std::printf("depth images: %s m per unit\n", short_text(*scale).c_str());
  }
  std::printf(
      "%zu %ss (%s): %s measured points, %s of them in the workspace; %s pixels out of range, %s "
      "invalid\n",
      taken, part_name(options), printable(source.sensor().name).c_str(),
      with_commas(totals.sum.readings).c_str(), with_commas(totals.sum.readings_inside).c_str(),
      with_commas(totals.sum.out_of_range).c_str(), with_commas(totals.sum.invalid).c_str());
  if (const std::string text = frames_text(totals.tally.counts()); !text.empty()) {
    std::printf("%s\n", text.c_str());
  }
  if (options.registration.is_on()) {
    std::printf("%s\n", registration_text(registration_counts(totals.registrations)).c_str());
  }
  if (totals.skipped > 0) {
    std::printf("frames skipped because the map has them: %zu\n", totals.skipped);
  }
  std::printf("%s", masked_text(options.frames, totals.masked_pixels).c_str());
  if (options.jump_edge_filter != "off") {
    std::printf("flying pixels removed: %s\n", with_commas(totals.jump_edge_removed).c_str());
  }
  if (options.support_plane) {
    std::printf("pixels on the support plane: %s\n",
                with_commas(totals.sum.plane_readings).c_str());
  }
  print_mended(source.orthonormalized());
  std::printf("%.2f s in total", seconds);
  if (frame_seconds) {
    std::printf("; integration: %.1f ms per %s (median)", 1e3 * *frame_seconds, part_name(options));
  }
  std::printf("\n");
  std::printf("%s: hash %s\n", options.out.c_str(), grid.content_hash().c_str());
}

// Refuses flags of depth frames for clouds, and of clouds for depth frames.
void check_flags(const Options& options, const App& app) {
  const auto refuse = [&app](std::initializer_list<const char*> flags, const char* why) {
    for (const char* flag : flags) {
      if (app.count(flag) > 0) app::refuse(std::string(flag) + " " + why);
    }
  };
  if (options.frames.folder.empty() == options.clouds.empty()) {
    app::refuse("give either FRAMES_DIR or --cloud");
  }
  if (options.clouds.empty()) {
    refuse({"--origin", "--poses"}, "requires --cloud");
  } else {
    refuse({"--depth-scale", "--mask", "--confidence", "--out-of-range", "--jump-edge-filter",
            "--obstacle", "--register"},
           "cannot be used with --cloud");
    if (!options.poses.empty()) refuse({"--origin"}, "cannot be used with --poses");
  }
}

// A map without readings results from a wrong scale, sensor or workspace.
void refuse_empty(const Options& options, const ReadingSource& source, const Totals& totals) {
  if (totals.skipped > 0) {
    totals.tally.name_left_out();
    if (totals.consistency) {
      totals.tally.warn_of_contradictions(*source.folder(), *totals.consistency);
    }
    return;
  }
  if (options.clouds.empty()) {
    return totals.tally.require_any(*source.folder(), source.grid(), *totals.consistency);
  }
  const IntegrationReport& sum = totals.sum;
  warn_if_out_of_range(options.clouds.front(), sum);
  if (!options.map.empty()) return;
  if (sum.readings_inside + sum.plane_readings + sum.voxels_crossed == 0) {
    refuse(options.clouds.front() + ": none of the " + with_commas(sum.readings) +
           " points lies in the workspace");
  }
  if (sum.readings > 0 && sum.readings_inside + sum.plane_readings == 0) {
    std::fprintf(
        stderr,
        "viewgain: warning: %s: none of the %s points lies in the workspace, so the cloud only "
        "marks free space. Are --poses and --workspace right?\n",
        options.clouds.front().c_str(), with_commas(sum.readings).c_str());
  }
}

void warn_of_set_up(const Options& options, const ReadingSource& source) {
  const Obstacles obstacles = obstacles_of(options.obstacles);
  app::warn_of_set_up({.sensor = source.sensor(),
                       .map = source.grid(),
                       .frames_follow = source.folder() != nullptr,
                       .obstacle_values = &options.obstacles,
                       .obstacles = &obstacles,
                       .support_plane = options.support_plane,
                       .pose_sigma = stated_sigma(options.registration)});
}

void integrate(const Options& options, const App& app) {
  const Stopwatch watch;
  check_flags(options, app);
  check_contradiction(options.frames, options.registration.is_on());
  check_map_name(options.out);
  const std::unique_ptr<ReadingSource> source = open_reading_source(options);
  source->start(options.map.empty() ? new_map(*source, options)
                                    : continued_map(source->sensor(), options));
  const BeliefGrid& grid = source->grid();
  warn_of_set_up(options, *source);
  const Totals totals = integrate_all(*source, options);
  refuse_empty(options, *source, totals);
  const LostInTree lost = save_map(grid, options.out);
  warn_of_lost_frame(lost, options.out);
  print_summary(options, *source, grid, totals, lost, watch.seconds());
}

}  // namespace

Command add_integrate(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand("integrate",
                                    "Integrate depth frames or point clouds into a voxel map.");
  app->add_option("FRAMES_DIR", options->frames.folder,
                  "folder of depth images with poses (see below)");
  begin_group(*app, "Point clouds");
  app->add_option(
         "--cloud", options->clouds,
         "point cloud (.pcd or .ply; x, y, z [m]) to integrate instead of frames; may be repeated")
      ->allow_extra_args(false);
  app->add_option(
      "--origin", options->origin,
      "x,y,z: position of the sensor [m], for clouds in the world frame; viewpoint: the VIEWPOINT "
      "in each .pcd file");
  app->add_option("--poses", options->poses,
                  "TUM file of sensor-to-world poses, line i for cloud i; clouds must then be in "
                  "the sensor's frame, and VIEWPOINT is ignored");
  begin_group(*app, "Map");
  app->add_option("--voxel", options->voxel, "voxel size [m] (required without --map)");
  app->add_option("--workspace", options->workspace,
                  "x0,y0,z0,x1,y1,z1: box to map [m] (default: all that the frames or clouds see)");
  app->add_option("--sensor", options->frames.sensor,
                  kSensorHelp + "; required for clouds (default: FRAMES_DIR/sensor.toml)");
  add_frame_folder_options(*app, options->frames);
  begin_group(*app, "Map");
  app->add_option("--jump-edge-filter", options->jump_edge_filter, kJumpEdgeHelp);
  add_scale_options(*app, options->scales);
  begin_group(*app, "Map");
  app->add_option("--support-plane", options->support_plane,
                  "height z of the table under the object [m]; pixels that see the table mark free "
                  "space, but no surface (default: none)");
  app->add_option("--prior-sigma", options->prior_sigma,
                  "standard deviation of an unknown voxel [m] (default: the larger of voxel/2 and "
                  "twice the sensor's noise along the ray at its working distance)");
  app->add_option("--obstacle", options->obstacles, kObstacleHelp)->allow_extra_args(false);
  add_registration_option(*app, options->registration);
  begin_group(*app, "Map");
  app->add_option("--out", options->out, "map to write (.vdb, or OctoMap .ot)")->required();
  app->add_option("--map", options->map,
                  "map to extend (.vdb, .ot or .bt); its voxel size, workspace and prior are kept; "
                  "frames that a .vdb map already contains are skipped");
  most_need(*app, {"--voxel", "--workspace", "--out", "--map", "--sensor", "--cloud",
                   "--support-plane", "--mask", "--register", "--on-contradiction"});
  explain_values(
      *app,
      "Files in FRAMES_DIR: those that simulate writes, or for each frame NNNNNN:\n"
      "  frame-NNNNNN.depth.png      16 bit: depth along z\n"
      "  frame-NNNNNN.pose.txt       4x4 matrix, camera to world [m]\n"
      "  camera-intrinsics.txt       3x3 matrix, optional; overrides the sensor's\n"
      "                              intrinsics\n"
      "  frame-NNNNNN.amplitude.png  16 bit, optional: cos(angle of incidence) /\n"
      "                              range^2 [1e-3 m^-2]\n"
      "With --cloud, the lines from the sensor to the points are marked as free space.\n");
  add_help(*app, kMapGroup,
           "integrate frames --voxel 0.005 --workspace -0.2,-0.2,-0.2,0.2,0.2,0.2 --out map.vdb");
  return command_of(app, options, [app](const auto& given) { integrate(given, *app); });
}

}  // namespace viewgain::app
