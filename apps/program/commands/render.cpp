// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdio>
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

struct Options {
  CommonOptions common;
  std::string map;
  std::string what;
  std::string out;
  std::string viewer = "30,24";
};

Viewer viewer_of(const Options& options) {
  constexpr double kDegree = std::numbers::pi / 180;
  const std::vector<double> n = parse_numbers("--viewer", options.viewer, 2, 3);
  const std::size_t width = n.size() > 2 ? parse_count("--viewer", n[2]) : 1280;
  if (width < 64 || width > 8192)
    refuse("--viewer " + options.viewer + ": WIDTH must be in 64..8192");
  return {kDegree * n[0], kDegree * n[1], static_cast<int>(width) / 4 * 4};
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

// Values that map to the darkest and the brightest colour.
using ColourRange = std::array<double, 2>;

struct Picture {
  RgbImage image;
  std::optional<ColourRange> sigmas{};
};

Picture picture_of(const Options& options, const ExecConfig& exec) {
  const BeliefGrid map = load_map(options.map, nullptr, {}, exec);
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
    std::printf("sigma along the surface normal: dark %.4g m, bright %.4g m\n", (*sigmas)[0],
                (*sigmas)[1]);
  }
  std::printf("%s: %d x %d px\n", options.out.c_str(), image.width, image.height);
}

}  // namespace

Command add_render(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "render", "Draw a map, or the result in a run's folder, as a PNG picture.");
  Options& o = *options;
  app->add_option("MAP", o.map, kMapHelp)->required();
  auto* what = app->add_option("KIND", o.what,
                               "what to draw: map (the voxels), surface, or sigma (the surface, "
                               "coloured by its standard deviation)")
                   ->required();
  what->check(one_of({"map", "surface", "sigma"}, "kind of picture"));
  app->add_option("--viewer", o.viewer,
                  "AZIMUTH,ELEVATION[,WIDTH]: direction to the viewer [deg] (azimuth 0: +x, 90: "
                  "+y) and picture width [px] (64..8192; default: 1280)");
  app->add_option("--out", o.out, "PNG file to write")->required();
  add_help(*app, kLookGroup, "render run sigma --out sigma.png");
  return command_of(app, options, [](const Options& given) { render(given); });
}

}  // namespace viewgain::app
