// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "show/pictures/map_picture.hpp"
#include "show/pictures/view_picture.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

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
};

Viewer viewer_of(const Options& options) {
  constexpr double kDegree = std::numbers::pi / 180;
  return {kDegree * options.azimuth, kDegree * options.elevation, options.width / 4 * 4};
}

// A map, or that of a run's folder.
std::string map_file(const std::string& input) {
  std::error_code ignored;
  return fs::is_directory(input, ignored) ? (fs::path(input) / "map.vdb").string() : input;
}
BeliefGrid map_of(const std::string& input, const ExecConfig& exec) {
  return load_map(map_file(input), nullptr, {}, exec);
}

// The surface in a map and the points that it goes through.
struct MapSurface {
  std::vector<FusedPoint> points;
  SurfaceMesh surface;
  std::vector<double> sigmas;

  MapSurface(const BeliefGrid& map, const ExecConfig& exec)
      : points(fused_points(map, {.scale_sigma = scale_sigma_of(map)}, exec)),
        surface(surface_of(points, exec)),
        sigmas(surface_sigmas(surface, points)) {}
};

// Dark up to the first, bright from the second on.
using ColourRange = std::array<double, 2>;

struct Picture {
  RgbImage image;
  std::optional<ColourRange> sigmas{};
};

Picture picture_of(const Options& options, const ExecConfig& exec) {
  const BeliefGrid map = map_of(options.input, exec);
  const Viewer viewer = viewer_of(options);
  if (options.what == "map") return {map_picture(map.snapshot(), viewer, exec)};
  MapSurface made(map, exec);
  SurfacePicture picture{made.surface};
  if (options.what == "surface") return {draw(picture, viewer, exec)};
  picture.sigma_range = usual_range(made.sigmas);
  picture.sigmas = std::move(made.sigmas);
  return {draw(picture, viewer, exec), picture.sigma_range};
}

void render(const Options& options) {
  check_finite("--azimuth", options.azimuth);
  check_finite("--elevation", options.elevation);
  const auto& [image, sigmas] = picture_of(options, exec_of(options.common));
  write_png(options.out, image);
  if (options.common.json) {
    Json json{{"what", options.what},
              {"width", image.width},
              {"height", image.height},
              {"colours", nullptr},
              {"out", options.out}};
    if (sigmas) {
      json["colours"] = {{"of", "sigma along the surface's normal"},
                         {"unit", "m"},
                         {"dark", (*sigmas)[0]},
                         {"bright", (*sigmas)[1]}};
    }
    return print_json(json);
  }
  if (sigmas) {
    std::printf("sigma along the surface's normal: from dark, %.4g m, to bright, %.4g m\n",
                (*sigmas)[0], (*sigmas)[1]);
  }
  std::printf("%s: %d x %d px\n", options.out.c_str(), image.width, image.height);
}

}  // namespace

Command add_render(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "render", "A picture of a map or of a run's folder, for papers and talks (PNG).");
  Options& o = *options;
  app->add_option("INPUT", o.input, "map (.vdb, .ot, .bt) or folder of reconstruct")->required();
  auto* what =
      app->add_option("--what", o.what, "map (its voxels), surface or sigma (how well it is known)")
          ->required();
  what->check(one_of({"map", "surface", "sigma"}, "kind of picture"));
  app->add_option("--width", o.width, "of the picture [px]")->check(CLI::Range(64, 8192, "width"));
  app->add_option("--azimuth", o.azimuth, "of the viewer, from +x to +y [deg]");
  app->add_option("--elevation", o.elevation, "of the viewer [deg]");
  app->add_option("--out", o.out, "PNG file to write")->required();
  add_common_options(*app, o.common);
  add_help(*app, kLookGroup, "render run --what sigma --out sigma.png");
  return {app, [options] { render(*options); }};
}

}  // namespace viewgain::app
