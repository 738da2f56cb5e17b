// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "program/commands/consistency_text.hpp"
#include "program/commands/reconstruct/run_outputs.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/quality.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::app {
namespace {

// Largest angle at which a sample counts as seen [rad].
constexpr double kSteepest = 80 * std::numbers::pi / 180;

struct Options {
  CommonOptions common;
  std::string map;
  std::string out, points;
  std::string truth;
  std::optional<double> size;
  std::string place, up = "z";
};

void check(const Options& options, const App& app) {
  if (options.out.empty() && options.points.empty()) refuse("give --out or --points");
  for (const char* flag : {"--size", "--place", "--up"}) {
    if (app.count(flag) > 0 && options.truth.empty()) {
      refuse(std::string(flag) + " requires --truth");
    }
  }
  if (options.size) check_positive("--size", *options.size);
}

std::shared_ptr<const SurfaceScene> truth_of(const Options& options, const ExecConfig& exec) {
  if (options.truth.empty()) return nullptr;
  const MeshPlacement placement = placement_of(options.size, options.place, options.up);
  MeshRepairs repairs;
  TriangleMesh mesh = read_mesh(options.truth, placement, &repairs);
  warn_of_repairs(options.truth, repairs);
  return std::make_shared<const SurfaceScene>(std::move(mesh), exec);
}

// Marks the samples that any of the views sees.
std::vector<std::uint8_t> seen_samples(const GroundTruth& truth, const SurfaceScene& mesh,
                                       const std::vector<Pose>& views, const Sensor& sensor,
                                       const ExecConfig& exec) {
  const std::vector<SurfaceSample>& samples = truth.samples();
  std::vector<std::uint8_t> seen(samples.size());
  ThreadPool pool(exec.num_threads);
  pool.for_each_chunk(samples.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (const Pose& view : views) {
      mark_seen(mesh, nullptr, sensor, view, std::cos(kSteepest),
                std::span(samples).subspan(begin, end - begin),
                std::span(seen).subspan(begin, end - begin));
    }
  });
  return seen;
}

// Samples count as visible if a view of the map sees them; NaN if there are none.
QualityFigures figures_of(const SurfaceScene& mesh, const BeliefGrid& map,
                          const SurfaceMesh& surface, const std::vector<FusedPoint>& points,
                          const ExecConfig& exec) {
  constexpr std::size_t kSamples = 10'000;
  constexpr std::uint64_t kSeed = 1;
  const GroundTruth truth(mesh.mesh(), kSamples, kSeed, exec);
  std::vector<std::uint8_t> seen(truth.samples().size());
  const std::optional<Sensor> sensor = map_sensor(map);
  if (sensor && !map.views().empty()) seen = seen_samples(truth, mesh, map.views(), *sensor, exec);
  return quality_figures(truth, surface, points, covered_within(map.voxel_size()), seen);
}

void print(const QualityFigures& figures, double voxel_size) {
  const double tolerance = 1e3 * covered_within(voxel_size);  // [mm]
  std::printf("coverage of the reference mesh: %.2f %% within %g mm, %.2f %% within 2.5 mm",
              100 * figures.coverage, tolerance, 100 * figures.coverage_2_5mm);
  if (!std::isnan(figures.coverage_visible)) {
    std::printf(
        "\n"
        "of the part that the map's views see: %.2f %% within %g mm (by the points %.2f %%, by the "
        "triangles %.2f %%)",
        100 * figures.coverage_visible, tolerance, 100 * figures.coverage_points,
        100 * figures.coverage_triangles);
  }
  std::printf(
      "\n"
      "error of the surface: RMS %.2f mm, 95 %% below %.2f mm; of the points: RMS %.2f mm, 95 %% "
      "below %.2f mm\n",
      1e3 * figures.surface_error.rms, 1e3 * figures.surface_error.p95,
      1e3 * figures.points_error.rms, 1e3 * figures.points_error.p95);
  std::printf("%s", consistency_text(figures.consistency).c_str());
}

// Warns of a reference mesh that lies elsewhere than the map or is much larger.
void warn_of_place(const Options& options, const TriangleMesh& truth, const BeliefGrid& grid) {
  constexpr double kTooLarge = 10;  // times the map
  const Box box = bounds_of(truth), map = grid.workspace();
  bool is_inside = longest_side(box) <= kTooLarge * longest_side(map);
  for (std::size_t a = 0; a < 3; ++a) {
    const double middle = 0.5 * (box.min[a] + box.max[a]);
    is_inside = is_inside && middle >= map.min[a] && middle <= map.max[a];
  }
  if (is_inside) return;
  std::fprintf(
      stderr,
      "viewgain: warning: %s lies in %s m, but the map lies in %s m. Is the mesh in metres, and "
      "at the place of the object? (--size, --place, --up)\n",
      options.truth.c_str(), describe(box).c_str(), describe(map).c_str());
}

void surface(const Options& options, const App& app) {
  const Stopwatch watch;
  check(options, app);
  const ExecConfig exec{options.common.threads};
  const std::shared_ptr<const SurfaceScene> truth = truth_of(options, exec);
  const BeliefGrid map = load_map(options.map, nullptr, {}, exec);
  const std::vector<FusedPoint> points =
      fused_points(map, {.scale_sigma = scale_sigma_of(map)}, exec);
  if (points.empty()) refuse(options.map + ": the map's voxels form no surface");
  const SurfaceMesh surface = surface_of(points, exec);
  std::optional<QualityFigures> figures;
  if (truth) {
    warn_of_place(options, truth->mesh(), map);
    figures = figures_of(*truth, map, surface, points, exec);
  }
  write_surfaces(surface, points, options.out, options.points);
  std::vector<double> sigmas = surface_sigmas(surface, points);
  std::optional<double> median;
  if (!sigmas.empty()) {
    const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
    std::nth_element(sigmas.begin(), middle, sigmas.end());
    median = *middle;
  }

  if (options.common.json) {
    return print_json({{"points", points.size()},
                       {"vertices", surface.vertices.size()},
                       {"triangles", surface.triangles.size()},
                       {"area", mesh_area(surface)},
                       {"median_sigma", median},
                       {"truth", figures ? quality_json(*figures, "coverage_seen") : Json()},
                       {"out", or_null(options.out)},
                       {"points_out", or_null(options.points)},
                       {"seconds", watch.seconds()}});
  }
  std::printf("%s points, %s vertices, %s triangles, %.4g m^2", with_commas(points.size()).c_str(),
              with_commas(surface.vertices.size()).c_str(),
              with_commas(surface.triangles.size()).c_str(), mesh_area(surface));
  if (median) std::printf(", median standard deviation %.2f mm", 1e3 * *median);
  std::printf("\n");
  if (figures) print(*figures, map.voxel_size());
  for (const std::string& file : {options.out, options.points}) {
    if (!file.empty()) std::printf("%s\n", file.c_str());
  }
}

}  // namespace

Command add_surface(App& program) {
  auto options = std::make_shared<Options>();
  App* app =
      program.add_subcommand("surface",
                             "Write the surface and the points of a map as PLY files. Each vertex "
                             "has a normal and a standard deviation along the normal [m]. With "
                             "--truth, compare surface and points with a reference mesh.");
  app->add_option("MAP", options->map, kMapHelp)->required();
  app->add_option("--out", options->out, "surface to write (.ply)");
  app->add_option("--points", options->points, "points to write (.ply)");
  app->add_option("--truth", options->truth,
                  "reference mesh (OFF, OBJ, STL, PLY) in the world frame");
  app->add_option(
      "--size", options->size,
      "length of the reference mesh's longest side after scaling [m] (default: no scaling)");
  app->add_option("--place", options->place,
                  "center: move the centre of the reference mesh's bounding box to the origin "
                  "(default: do not move)")
      ->check(one_of({"center"}, "value"));
  app->add_option("--up", options->up, "axis of the reference mesh's file that points up")
      ->check(one_of({"x", "y", "z"}, "axis"));
  add_help(*app, kLookGroup, "surface map.vdb --out surface.ply --points points.ply");
  return command_of(app, options, [app](const auto& given) { surface(given, *app); });
}

}  // namespace viewgain::app
