// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string map;
  std::string criterion = "log_diagonal";
  std::string region;
};

struct Region {
  Box box;
  BeliefGrid::Statistics statistics;
  double mean_sigma;  // [m]
};

std::optional<Region> region_of(const Options& options, const BeliefGrid& grid,
                                Criterion criterion) {
  if (options.region.empty()) return std::nullopt;
  const Box box = parse_box("--workspace", options.region);
  const BeliefGrid::Statistics s = grid.statistics(box, criterion);
  if (s.unknown + s.free + s.occupied == 0) {
    refuse("--workspace " + options.region + ": the box contains no voxel of the map");
  }
  return Region{box, s, grid.mean_sigma(box)};
}

Json region_json(const Region& region) {
  const BeliefGrid::Statistics& s = region.statistics;
  return {{"box", to_json(region.box)},
          {"entropy_removed", s.entropy_removed},
          {"mean_sigma", region.mean_sigma},  // a NaN becomes null
          {"hits", s.hits},
          {"unknown", s.unknown},
          {"free", s.free},
          {"occupied", s.occupied}};
}

void print(const Region& region, const char* unit) {
  const BeliefGrid::Statistics& s = region.statistics;
  std::printf("region           %s m (grid frame)\n", describe(region.box).c_str());
  std::printf("  unknown        %s\n", with_commas(s.unknown).c_str());
  std::printf("  free           %s\n", with_commas(s.free).c_str());
  std::printf("  occupied       %s\n", with_commas(s.occupied).c_str());
  std::printf("  entropy removed %.6g %s\n", s.entropy_removed, unit);
  std::printf("  mean sigma     %.4g m\n", region.mean_sigma);
  std::printf("  hits           %s\n", with_commas(s.hits).c_str());
}

// Hazard factors learnt from frames; null if no frame was counted.
Json hazard_factors(const BeliefGrid& grid) {
  const HazardCounters& counters = grid.hazard_counters();
  if (counters.empty()) return nullptr;
  Json factors = Json::array();
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) factors.push_back(counters.factor(k));
  return factors;
}

void info(const Options& options) {
  const Criterion criterion = parse_criterion(options.criterion);
  const BeliefGrid grid = load_map(options.map, nullptr, {}, exec_of(options.common));
  const std::optional<Sensor> sensor = map_sensor(grid);
  const std::optional<Region> region = region_of(options, grid, criterion);
  const BeliefGrid::Statistics statistics = grid.statistics(criterion);
  const Index3 dims = grid.dims();
  const double per_occupied = static_cast<double>(statistics.bytes) /
                              static_cast<double>(statistics.occupied);  // NaN or infinity: null
  if (options.common.json) {
    Json json{{"voxel_size", grid.voxel_size()},
              {"workspace", to_json(grid.workspace())},
              {"T_world_grid", to_json(grid.T_world_grid())},
              {"dims", {dims.x, dims.y, dims.z}},
              {"unknown", statistics.unknown},
              {"free", statistics.free},
              {"occupied", statistics.occupied},
              {"bytes", statistics.bytes},
              {"bytes_per_occupied_voxel", per_occupied},
              {"criterion", criterion_name(criterion)},
              {"entropy_removed", statistics.entropy_removed},
              {"prior_sigma", grid.prior_sigma()},
              {"views", grid.views().size()},
              {"sensor", sensor ? Json(sensor->name) : Json()},
              {"hazard_factors", hazard_factors(grid)},
              {"hash", grid.content_hash()}};
    if (region) json["region"] = region_json(*region);
    print_json(json);
    return;
  }
  const char* unit = criterion == Criterion::trace ? "m^2" : "nat";
  std::printf("workspace        %s m (grid frame)\n", describe(grid.workspace()).c_str());
  std::printf("voxels           %d x %d x %d of %g m\n", dims.x, dims.y, dims.z, grid.voxel_size());
  std::printf("unknown          %s\n", with_commas(statistics.unknown).c_str());
  std::printf("free             %s\n", with_commas(statistics.free).c_str());
  std::printf("occupied         %s\n", with_commas(statistics.occupied).c_str());
  if (statistics.occupied > 0) {
    std::printf("memory           %s bytes, %.1f per occupied voxel\n",
                with_commas(statistics.bytes).c_str(), per_occupied);
  } else {
    std::printf("memory           %s bytes\n", with_commas(statistics.bytes).c_str());
  }
  std::printf("entropy removed  %.6g %s (%s)\n", statistics.entropy_removed, unit,
              options.criterion.c_str());
  std::printf("prior sigma      %g m\n", grid.prior_sigma());
  std::printf("views            %zu\n", grid.views().size());
  if (sensor) std::printf("sensor           %s\n", printable(sensor->name).c_str());
  if (const HazardCounters& counters = grid.hazard_counters(); !counters.empty()) {
    std::printf("hazard factors  ");
    for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
      std::printf(" %.2f", counters.factor(k));
    }
    std::printf("  (from near to far from known surface)\n");
  }
  std::printf("hash             %s\n", grid.content_hash().c_str());
  if (region) print(*region, unit);
}

}  // namespace

Command add_info(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand(
      "info",
      "Print properties of a map: size, voxel states, memory, entropy removed, number of views.");
  app->add_option("MAP", options->map, kMapHelp)->required();
  app->add_option("--criterion", options->criterion,
                  "criterion of the entropy: log_diagonal, log_determinant [nat] or trace [m^2]")
      ->check(one_of(criterion_names(), "criterion"));
  app->add_option("--workspace", options->region,
                  "x0,y0,z0,x1,y1,z1: box to report separately, in grid coordinates [m]");
  add_help(*app, kLookGroup, "info map.vdb --criterion trace");
  return command_of(app, options, info);
}

}  // namespace viewgain::app
