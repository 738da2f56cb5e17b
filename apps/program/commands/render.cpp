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

#include "program/cli/choices.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/pose_flags.hpp"
#include "program/cli/flags/sensed_map.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "show/pictures/image_grid.hpp"
#include "show/pictures/map_picture.hpp"
#include "show/pictures/surface_picture.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNormalSigma = "sigma along the surface's normal";

struct Options {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string what;
  std::string out;
  std::optional<int> width;
  double azimuth = 30, elevation = 24;  // [deg]
  std::optional<double> ellipsoids;
  std::string views;
  std::size_t columns = 3;
  PoseOptions poses;
  std::string sensor;
  std::uint64_t seed = 1;
  std::string gain = "paper";
};

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what);
}

// What a kind of picture has no use for would be ignored in silence.
void check(const Options& options, const App& app) {
  const auto only_for = [&](const std::string& what, std::initializer_list<const char*> flags) {
    if (options.what == what) return;
    for (const char* flag : flags) {
      if (app.count(flag) > 0) refuse(std::string(flag) + " goes with --what " + what);
    }
  };
  only_for("sigma", {"--ellipsoids"});
  only_for("step", {"--views", "--columns"});
  only_for("gain", {"--poses", "--sphere", "--dome", "--rings", "--shell", "--orbit", "--center",
                    "--seed", "--sensor", "--gain"});
  if (options.what == "step" && (app.count("--azimuth") > 0 || app.count("--elevation") > 0)) {
    refuse("--azimuth and --elevation do not go with --what step, which puts pictures together");
  }
  if (options.what != "sheet" && options.inputs.size() > 1) {
    refuse("--what " + options.what + " draws one map or run; several go with sheet");
  }
  if (options.ellipsoids) check_positive("--ellipsoids", *options.ellipsoids);
  check_finite("--azimuth", options.azimuth);
  check_finite("--elevation", options.elevation);
}

Viewer viewer_of(const Options& options, int usual_width) {
  constexpr double kDegree = std::numbers::pi / 180;
  return {kDegree * options.azimuth, kDegree * options.elevation,
          options.width.value_or(usual_width) / 4 * 4};
}

// A map, or that of a run's folder.
std::string map_file(const std::string& input) {
  std::error_code ignored;
  return fs::is_directory(input, ignored) ? (fs::path(input) / "map.vdb").string() : input;
}
BeliefGrid map_of(const std::string& input) { return load_map(map_file(input)); }

// The surface in a map and the points that it goes through.
struct MapSurface {
  std::vector<FusedPoint> points;
  SurfaceMesh surface;
  std::vector<double> sigmas;

  MapSurface(const BeliefGrid& grid, const ExecConfig& exec)
      : points(fused_points(grid, {}, exec)),
        surface(surface_of(points, grid.voxel_size(), exec)),
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
  const MapSurface made(map_of(options.inputs.front()), exec);
  const Viewer viewer = viewer_of(options, 1280);
  if (!options.ellipsoids) {
    const auto range = usual_range(made.sigmas);
    return {surface_image(made, true, range, viewer, exec), ColourRange{kNormalSigma, "m", range}};
  }
  SurfacePicture picture{made.surface};
  picture.points = &made.points;
  picture.ellipsoid_sigmas = *options.ellipsoids;
  picture.sigma_range = usual_range(longest_sigmas(made.points));
  return {draw(picture, viewer, exec),
          ColourRange{"sigma along the longest axis", "m", picture.sigma_range}};
}

Picture gain_picture(const Options& options, const ExecConfig& exec) {
  if (options.poses.none()) refuse("--what gain needs poses, say --sphere 500,0.6");
  const std::vector<Pose> poses = make_poses(options.poses, options.seed).poses;
  const auto [grid, sensor] = load_sensed_map(map_file(options.inputs.front()), options.sensor);
  const auto scene = VoxelScene::build(grid, {}, exec);
  GainConfig config;
  config.model = parse_gain_model(options.gain);
  std::vector<double> gains;
  for (const ViewGain& gain : GainEvaluator(scene, sensor, config, exec).evaluate(poses)) {
    gains.push_back(gain.gain);
  }
  const std::array<double, 2> range = range_of(gains);
  return {app::gain_picture(scene->snapshot(), sensor, poses, gains, range,
                            viewer_of(options, 1280), exec),
          ColourRange{options.gain + " gain", std::string(gain_unit(config.model, "log_diagonal")),
                      range}};
}

// The numbers of the run's views that are shown: those given, or up to six, evenly.
std::vector<std::size_t> shown_views(const Options& options, std::size_t count) {
  std::vector<std::size_t> shown;
  if (options.views.empty()) {
    constexpr std::size_t kUsual = 6;
    const std::size_t most = std::min(kUsual, count);
    for (std::size_t i = 0; i < most; ++i)
      shown.push_back(i * (count - 1) / (most - 1 + (most == 1)));
    return shown;
  }
  for (const double number : parse_numbers("--views", options.views, 1, 1000)) {
    shown.push_back(parse_count("--views", number));
    if (shown.back() >= count) {
      refuse("--views " + options.views + ": the run has views 0 to " + std::to_string(count - 1));
    }
  }
  return shown;
}

RgbImage step_picture(const Options& options) {
  const fs::path folder = fs::path(options.inputs.front()) / "views";
  const auto picture = [&](std::size_t view) {
    std::string name = std::to_string(view);
    return folder / (name.insert(0, name.size() < 2 ? "0" : "").append(".png"));
  };
  std::size_t count = 0;
  std::error_code ignored;
  while (fs::exists(picture(count), ignored)) ++count;
  if (count == 0) {
    refuse(options.inputs.front() +
           ": has no views/00.png; --what step needs the folder of a run with pictures");
  }
  std::vector<RgbImage> images;
  for (const std::size_t view : shown_views(options, count)) {
    const RgbImage image = read_rgb_png(picture(view));
    const int width = options.width.value_or(640);
    const int factor = (image.width + width - 1) / width;
    if (image.height < factor) refuse(picture(view).string() + ": is too flat to be shown");
    images.push_back(shrunk(image, factor));
    if (images.back().width != images.front().width ||
        images.back().height != images.front().height) {
      refuse(picture(view).string() + ": is of another size than the others");
    }
  }
  return image_grid(images, options.columns);
}

// A row a map: voxels, surface, sigma, the colours of sigma the same in all rows.
Picture sheet_picture(const Options& options, const ExecConfig& exec) {
  std::vector<BeliefGrid> grids;
  std::vector<MapSurface> made;
  std::vector<double> sigmas;
  for (const std::string& input : options.inputs) {
    grids.push_back(map_of(input));
    made.emplace_back(grids.back(), exec);
    sigmas.insert(sigmas.end(), made.back().sigmas.begin(), made.back().sigmas.end());
  }
  const auto range = usual_range(std::move(sigmas));
  const Viewer viewer = viewer_of(options, 640);
  std::vector<RgbImage> images;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    images.push_back(map_picture(grids[i].snapshot(), viewer, exec));
    images.push_back(surface_image(made[i], false, range, viewer, exec));
    images.push_back(surface_image(made[i], true, range, viewer, exec));
  }
  return {image_grid(images, 3), ColourRange{kNormalSigma, "m", range}};
}

Picture picture_of(const Options& options, const ExecConfig& exec) {
  if (options.what == "step") return {step_picture(options)};
  if (options.what == "sheet") return sheet_picture(options, exec);
  if (options.what == "sigma") return sigma_picture(options, exec);
  if (options.what == "gain") return gain_picture(options, exec);
  const BeliefGrid grid = map_of(options.inputs.front());
  const Viewer viewer = viewer_of(options, 1280);
  if (options.what == "map") return {map_picture(grid.snapshot(), viewer, exec)};
  return {surface_image(MapSurface(grid, exec), false, {}, viewer, exec)};
}

void render(const Options& options, const App& app) {
  check(options, app);
  const Picture picture = picture_of(options, {options.common.threads});
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
  app->add_option("INPUT", o.inputs,
                  "map (.vdb, .ot, .bt) or folder of reconstruct; sheet: several")
      ->required();
  auto* what =
      app->add_option(
             "--what", o.what,
             "map (its voxels), surface, sigma (how well it is known), gain (poses, which it "
             "needs, by what they gain), step (pictures of a run side by side) or sheet (a row a "
             "map: voxels, surface, sigma)")
          ->required();
  one_of(*what, {"map", "surface", "sigma", "gain", "step", "sheet"}, "kind of picture");
  app->add_option("--width", o.width,
                  "of the picture [px], of each where there are several, of step at most; default: "
                  "1280, sheet and step 640")
      ->range(64, 8192, "width");
  app->add_option("--azimuth", o.azimuth, "of the viewer, from +x to +y [deg]")
      ->capture_default_str();
  app->add_option("--elevation", o.elevation, "of the viewer [deg]")->capture_default_str();
  app->add_option("--ellipsoids", o.ellipsoids,
                  "sigma: the points as ellipsoids of so many standard deviations instead of the "
                  "surface");
  app->add_option("--views", o.views,
                  "step: numbers of views, say 0,2,5; default: up to six, evenly");
  app->add_option("--columns", o.columns, "step: pictures in a row")
      ->range(std::size_t{1}, std::size_t{100}, "count")
      ->capture_default_str();
  add_pose_options(*app, o.poses, false);
  add_seed_option(*app, o.seed, "of --shell");
  app->add_option("--sensor", o.sensor, std::string("gain: ").append(kMapSensorHelp));
  auto* gain = app->add_option("--gain", o.gain, "gain: paper, surface or combined, as in score");
  one_of(*gain->capture_default_str(), gain_model_names(), "gain");
  app->add_option("--out", o.out, "PNG file to write")->required();
  add_common_options(*app, o.common);
  add_help(*app, kLookGroup, "render run --what sigma --out sigma.png");
  return {app, [options, app] { render(*options, *app); }};
}

}  // namespace viewgain::app
