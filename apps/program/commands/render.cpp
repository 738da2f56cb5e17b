// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/pose_source.hpp"
#include "program/cli/flags/sensed_map.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "show/pictures/map_picture.hpp"
#include "show/pictures/surface_picture.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/pooling.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  CommonOptions common;
  std::string input;
  std::string what;
  std::string out;
  int width = 1280;
  double azimuth = 30, elevation = 24;  // [deg]
  PoseOptions poses;
  std::string sensor;
  std::uint64_t seed = 1;
  std::string gain = default_gain();
};

// What a kind of picture has no use for would be ignored in silence.
void check(const Options& options, const App& app) {
  for (const char* flag : {"--poses", "--sphere", "--dome", "--rings", "--shell", "--orbit",
                           "--center", "--seed", "--sensor", "--gain"}) {
    if (options.what != "gain" && app.count(flag) > 0) {
      refuse(std::string(flag) + " goes with --what gain");
    }
  }
  check_finite("--azimuth", options.azimuth);
  check_finite("--elevation", options.elevation);
}

Viewer viewer_of(const Options& options) {
  constexpr double kDegree = std::numbers::pi / 180;
  return {kDegree * options.azimuth, kDegree * options.elevation, options.width / 4 * 4};
}

// A map, or that of a run's folder.
std::string map_file(const std::string& input) {
  std::error_code ignored;
  return fs::is_directory(input, ignored) ? (fs::path(input) / "map.vdb").string() : input;
}
MapOfSensor map_of(const std::string& input, const ExecConfig& exec) {
  return load_map_of_sensor(map_file(input), nullptr, {}, exec);
}

// The surface in a map and the points that it goes through.
struct MapSurface {
  std::vector<FusedPoint> points;
  SurfaceMesh surface;
  std::vector<double> sigmas;

  MapSurface(const MapOfSensor& map, const ExecConfig& exec)
      : points(fused_points(map.grid, {.scale_sigma = map.sensor ? map.sensor->scale_sigma : 0.0},
                            exec)),
        surface(surface_of(points, pooling_of(map.grid.snapshot()), exec)),
        sigmas(surface_sigmas(surface, points)) {}
};

// What colours stand for: dark up to the first, bright from the second on.
struct ColourRange {
  std::string what, unit;
  std::array<double, 2> range;
};

struct Picture {
  RgbImage image;
  std::optional<ColourRange> colours{};
};

RgbImage surface_image(const MapSurface& made, bool with_sigma, std::array<double, 2> range,
                       const Viewer& viewer, const ExecConfig& exec) {
  SurfacePicture picture{made.surface};
  if (with_sigma) picture.sigmas = made.sigmas;
  picture.sigma_range = range;
  return draw(picture, viewer, exec);
}

Picture sigma_picture(const Options& options, const ExecConfig& exec) {
  const MapSurface made(map_of(options.input, exec), exec);
  const auto range = usual_range(made.sigmas);
  return {surface_image(made, true, range, viewer_of(options), exec),
          ColourRange{"sigma along the surface's normal", "m", range}};
}

Picture gain_picture(const Options& options, const ExecConfig& exec) {
  if (options.poses.none()) refuse("--what gain needs poses, say --sphere 500,0.6");
  const std::vector<Pose> poses = make_poses(options.poses, options.seed).poses;
  const auto [grid, sensor] = load_sensed_map(map_file(options.input), options.sensor, exec);
  const auto scene = VoxelScene::build(grid, {}, exec);
  GainConfig config;
  config.model = parse_gain_model(options.gain);
  std::vector<double> gains;
  for (const ViewGain& gain : GainEvaluator(scene, sensor, config, exec).evaluate(poses)) {
    gains.push_back(gain.gain);
  }
  const std::array<double, 2> range = range_of(gains);
  return {
      app::gain_picture(scene->snapshot(), sensor, poses, gains, range, viewer_of(options), exec),
      ColourRange{options.gain + " gain", std::string(gain_unit(config.model, "log_diagonal")),
                  range}};
}

Picture picture_of(const Options& options, const ExecConfig& exec) {
  if (options.what == "sigma") return sigma_picture(options, exec);
  if (options.what == "gain") return gain_picture(options, exec);
  const MapOfSensor map = map_of(options.input, exec);
  const Viewer viewer = viewer_of(options);
  if (options.what == "map") return {map_picture(map.grid.snapshot(), viewer, exec)};
  return {surface_image(MapSurface(map, exec), false, {}, viewer, exec)};
}

void render(const Options& options, const App& app) {
  check(options, app);
  const Picture picture = picture_of(options, exec_of(options.common));
  write_png(options.out, picture.image);
  if (options.common.json) {
    Json json{{"what", options.what},
              {"width", picture.image.width},
              {"height", picture.image.height},
              {"colours", nullptr},
              {"out", options.out}};
    if (picture.colours) {
      json["colours"] = {{"of", picture.colours->what},
                         {"unit", picture.colours->unit},
                         {"dark", picture.colours->range[0]},
                         {"bright", picture.colours->range[1]}};
    }
    return print_json(json);
  }
  if (picture.colours) {
    std::printf("%s: from dark, %.4g %s, to bright, %.4g %s\n", picture.colours->what.c_str(),
                picture.colours->range[0], picture.colours->unit.c_str(), picture.colours->range[1],
                picture.colours->unit.c_str());
  }
  std::printf("%s: %d x %d px\n", options.out.c_str(), picture.image.width, picture.image.height);
}

}  // namespace

Command add_render(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "render", "A picture of a map or of a run's folder, for papers and talks (PNG).");
  Options& o = *options;
  app->add_option("INPUT", o.input, "map (.vdb, .ot, .bt) or folder of reconstruct")->required();
  auto* what =
      app->add_option(
             "--what", o.what,
             "map (its voxels), surface, sigma (how well it is known) or gain (poses, which it "
             "needs, by what they gain)")
          ->required();
  what->check(one_of({"map", "surface", "sigma", "gain"}, "kind of picture"));
  app->add_option("--width", o.width, "of the picture [px]")
      ->check(CLI::Range(64, 8192, "width"))
      ->capture_default_str();
  app->add_option("--azimuth", o.azimuth, "of the viewer, from +x to +y [deg]")
      ->capture_default_str();
  app->add_option("--elevation", o.elevation, "of the viewer [deg]")->capture_default_str();
  add_pose_options(*app, o.poses, false);
  add_seed_option(*app, o.seed, "of --shell");
  app->add_option("--sensor", o.sensor, std::string("gain: ").append(kMapSensorHelp));
  auto* gain = app->add_option("--gain", o.gain, "gain: paper, surface or combined, as in score");
  gain->capture_default_str()->check(one_of(gain_model_names(), "gain"));
  app->add_option("--out", o.out, "PNG file to write")->required();
  add_trace_option(*app, o.common);
  add_common_options(*app, o.common);
  add_help(*app, kLookGroup, "render run --what sigma --out sigma.png");
  return {app, [options, app] { render(*options, *app); }};
}

}  // namespace viewgain::app
