// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/map_file.hpp"

#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/core/file_bytes.hpp"
#include "viewgain/formats/file_names.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

constexpr const char* kSensorNote = "sensor";  // in the metadata of a .vdb: sensor_toml()

}  // namespace

bool is_octomap(const std::filesystem::path& path) {
  return small_ending(path) == ".ot" || small_ending(path) == ".bt";
}

BeliefGrid load_map(const std::filesystem::path& path, const Sensor* sensor, OctomapConfig config) {
  return load_map_of_sensor(path, sensor, config).grid;
}

MapOfSensor load_map_of_sensor(const std::filesystem::path& path, const Sensor* sensor,
                               OctomapConfig config) {
  if (!is_octomap(path)) {
    VdbMap map = load_vdb_map(path);
    const auto note = map.notes.find(kSensorNote);
    if (note == map.notes.end()) return {std::move(map.grid), std::nullopt};
    return {std::move(map.grid), parse_sensor_toml(note->second, path.string())};
  }
  const std::string bytes = file_bytes(path);  // once: a pipe cannot be opened again
  if (sensor != nullptr && !config.prior_sigma) {
    config.prior_sigma =
        default_prior_sigma(octomap_resolution_of_bytes(bytes, path.string()), *sensor);
  }
  return {grid_from_octomap_bytes(bytes, config, path.string()), std::nullopt};
}

VdbWriteConfig noting_sensor(const Sensor& sensor, VdbWriteConfig config) {
  config.notes[kSensorNote] = sensor_toml(sensor);
  return config;
}

void check_map_name(const std::filesystem::path& path) {
  const std::string end = small_ending(path);
  if (end == ".bt") {
    throw Error(ErrorCode::invalid_argument,
                path.string() + ": .bt files are read but not written; .ot ones are");
  }
  if (end == ".vdb" || end == ".ot" || is_special_file(path)) return;
  throw Error(ErrorCode::invalid_argument,
              path.string() + ": the name of a map to write must end in .vdb or .ot");
}

LostInTree save_map(const BeliefGrid& grid, const std::filesystem::path& path,
                    const VdbWriteConfig& config) {
  check_map_name(path);
  if (!is_octomap(path)) {
    save_vdb(grid, path, config);
    return {};
  }
  save_octomap(grid, path);
  LostInTree lost;
  for (const BeliefBlockAt& block : grid.belief_blocks()) {
    lost.beliefs += block.beliefs->beliefs.size();
  }
  lost.views = grid.views().size();
  lost.hazard_counters = !grid.hazard_counters().empty();
  lost.T_world_grid = !octomap_keeps_frame(grid);
  return lost;
}

}  // namespace viewgain
