// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/scene_sources.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/suspect_frames.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

std::string readings_of(Sensor sensor) {
  sensor.name.clear();
  sensor.body_size.reset();
  sensor.T_flange_camera.reset();
  return sensor_toml(sensor);
}

// The first line in which the sensors' files differ: "fx = 585.0 there, fx = 525.0 here".
std::string difference(const Sensor& there, const Sensor& here) {
  std::istringstream of_there(readings_of(there)), of_here(readings_of(here));
  std::string a, b;
  do {
    std::getline(of_there, a);
    std::getline(of_here, b);
  } while (a == b && of_there && of_here);
  const auto shown = [](const std::string& line) { return line.substr(0, line.find("  #")); };
  return shown(a) + " in the map, " + shown(b) + " in --sensor";
}

}  // namespace

namespace {

// The value without the object's size.
std::string rates_of(const std::string& hazard) {
  if (!hazard.starts_with("size=")) return hazard;
  const std::size_t comma = hazard.find(',');
  if (comma == std::string::npos) return "";
  if (comma + 1 == hazard.size())
    refuse("--hazard " + hazard + ": the value must not end in a comma");
  return hazard.substr(comma + 1);
}

}  // namespace

std::string hazard_file_of(const std::string& value) {
  const std::string rates = rates_of(value);
  return small_ending(rates) == ".vdb" ? rates : "";
}

std::optional<double> object_size_of(const std::string& hazard) {
  if (!hazard.starts_with("size=")) return std::nullopt;
  const double size =
      parse_numbers("--hazard size", hazard.substr(5, hazard.find(',') - 5), 1, 1)[0];
  check_positive("--hazard size", size);
  return size;
}

void add_hazard_option(App& app, std::string& text) {
  const std::string reference = explain_values_in(
      "score", app,
      "Values of --hazard; RATE or FILE.vdb can follow size=L, as in size=0.3,5:\n"
      "  RATE      one rate for all unknown voxels [1/m]\n"
      "  FILE.vdb  one rate per voxel\n"
      "  size=L    longest side of the object [m] (default: of the part seen so far)\n"
      "  By default, the rate is high near known surface and falls with the distance\n"
      "  from it. It is higher beside the surface than in front of it or behind it.\n");
  app.add_option("--hazard", text,
                 "rate at which rays meet surface in unknown voxels: RATE [1/m], FILE.vdb or "
                 "size=L (requires --gain surface or combined; " +
                     reference + ")");
}

HazardConfig hazard_source(const std::string& text, const BeliefGrid& grid) {
  const std::optional<double> object_size = object_size_of(text);
  const std::string hazard = rates_of(text);
  HazardConfig config;
  config.object_size = object_size;
  if (hazard.empty()) return config;
  if (!hazard_file_of(hazard).empty()) {
    config.volume = std::make_shared<const HazardConfig::Volume>(load_hazard_vdb(hazard, grid));
    return config;
  }
  if (!small_ending(hazard).empty() &&
      hazard.find_first_not_of("0123456789.+-eE") != std::string::npos) {
    refuse("--hazard " + hazard + ": the value must be a number or a .vdb file");
  }
  const double rate = parse_numbers("--hazard", hazard, 1, 1)[0];
  check_at_least_0("--hazard", rate);
  return constant_hazard(rate, grid, object_size);
}

MeshPlacement placement_of(std::optional<double> size, const std::string& place,
                           const std::string& up) {
  MeshPlacement placement;
  placement.up = up == "x" ? UpAxis::x : up == "y" ? UpAxis::y : UpAxis::z;
  placement.center = place.starts_with("center");
  if (size) placement.longest_side = *size;
  return placement;
}

bool is_obstacle_file(const std::string& value) {
  return value.find_first_not_of("0123456789.,+-eE ") != std::string::npos;
}

Obstacles obstacles_of(const std::vector<std::string>& values) {
  Obstacles obstacles;
  for (const std::string& value : values) {
    if (is_obstacle_file(value)) {
      MeshRepairs repairs;
      obstacles.meshes.push_back(read_mesh(value, &repairs));
      warn_of_repairs(value, repairs);
    } else {
      obstacles.boxes.push_back(parse_box("--obstacle", value));
    }
  }
  return obstacles;
}

void warn_of_few_voxels(const BeliefGrid& grid) {
  constexpr int kFew = 8;
  const Index3 dims = grid.dims();
  const int longest = std::max({dims.x, dims.y, dims.z});
  if (longest >= kFew) return;
  std::fprintf(
      stderr,
      "viewgain: warning: at --voxel %s m, the longest side of the workspace has only %d voxel%s; "
      "--voxel must be in metres, not in millimetres\n",
      short_text(grid.voxel_size()).c_str(), longest, longest == 1 ? "" : "s");
}

void warn_of_repairs(const std::string& file, const MeshRepairs& repairs) {
  const auto faces = [](std::size_t count, const char* one, const char* several) {
    return with_commas(count) + (count == 1 ? one : several);
  };
  std::string text;
  if (repairs.mended_faces > 0) {
    text = faces(repairs.mended_faces, " face crosses itself and was",
                 " faces cross themselves and were") +
           " split at the crossings";
  }
  if (repairs.dropped_faces > 0) {
    if (!text.empty()) text += "; ";
    text += faces(repairs.dropped_faces, " face without area was", " faces without area were") +
            " removed";
  }
  if (text.empty()) return;
  std::fprintf(stderr, "viewgain: warning: %s: %s\n", file.c_str(), text.c_str());
}

void warn_of_poses(const std::string& file, const std::vector<Pose>& poses,
                   const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor) {
  const std::string suspicion = suspect_poses(scene, sensor, poses).what;
  if (suspicion.empty()) return;
  std::fprintf(stderr, "viewgain: warning: %s: %s\n", file.c_str(), suspicion.c_str());
}

double scale_sigma_of(const BeliefGrid& grid) {
  const std::optional<Sensor> sensor = map_sensor(grid);
  return sensor ? sensor->scale_sigma : 0;
}

bool is_same_sensor(const Sensor& a, const Sensor& b) { return readings_of(a) == readings_of(b); }

bool warn_of_other_sensor(const std::string& path, const BeliefGrid& grid, const Sensor& sensor) {
  const std::optional<Sensor> noted = map_sensor(grid);
  if (!noted || is_same_sensor(*noted, sensor)) return false;
  std::fprintf(stderr,
               "viewgain: warning: %s was made with the sensor %s; --sensor %s differs: %s\n",
               path.c_str(), printable(noted->name).c_str(), printable(sensor.name).c_str(),
               printable(difference(*noted, sensor)).c_str());
  return true;
}

// Whether occupied voxels have no readings, as in a map of another program.
bool has_states_alone(const BeliefGrid& grid) {
  if (!grid.views().empty() || grid.statistics().occupied == 0) return false;
  bool is_measured = false;
  grid.for_each_belief([&](Index3, const Belief&) { is_measured = true; });
  return !is_measured;
}

SensedMap load_sensed_map(const std::string& path, const std::string& sensor_flag,
                          const ExecConfig& exec) {
  std::optional<Sensor> asked;
  if (!sensor_flag.empty()) asked = load_sensor(sensor_flag);
  BeliefGrid grid = load_map(path, asked ? &*asked : nullptr, {}, exec);
  if (asked) warn_of_other_sensor(path, grid, *asked);
  std::optional<Sensor> sensor = asked ? std::move(asked) : map_sensor(grid);
  if (!sensor) {
    refuse(path + ": the map does not name its sensor; give --sensor");
  }
  if (is_octomap(path) || has_states_alone(grid)) {
    std::fprintf(
        stderr,
        "viewgain: note: %s has only voxel states. Its past views are unknown, and the accuracy "
        "of its known surface is unknown; --gain surface is not affected\n",
        path.c_str());
  }
  return {std::move(grid), *std::move(sensor)};
}

void require_known(const BeliefGrid& grid, const std::string& path) {
  if (grid.statistics().unknown < grid.voxel_count()) return;
  refuse(path +
         ": all voxels are unknown. Was the map made with a wrong workspace, a wrong scale, or "
         "poses that are world to camera?");
}

}  // namespace viewgain::app
