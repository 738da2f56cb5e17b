// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/map_file.hpp"

#include <string>
#include <system_error>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"

namespace viewgain {

bool is_octomap(const std::filesystem::path& path) {
  return small_ending(path) == ".ot" || small_ending(path) == ".bt";
}

std::filesystem::path map_in(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return path;
  const bool is_done = std::filesystem::exists(path / "map.vdb", ignored);
  return path / (is_done ? "map.vdb" : "state.vdb");
}

BeliefGrid load_map(const std::filesystem::path& file_or_run, const Sensor* sensor,
                    OctomapConfig config, const ExecConfig& exec) {
  const std::filesystem::path path = map_in(file_or_run);
  std::error_code ignored;
  if (path != file_or_run && !std::filesystem::exists(path, ignored)) {
    throw Error(ErrorCode::io,
                file_or_run.string() + ": the folder has no map.vdb and no state.vdb");
  }
  if (!is_octomap(path)) {
    BeliefGrid grid = load_vdb(path, exec);
    MapNotes notes = grid.notes();
    if (notes.sensor.empty()) return grid;
    // Rewritten in this version's format, so that equal sensors have equal notes.
    notes.sensor = sensor_toml(parse_sensor_toml(notes.sensor, path.string()));
    grid.set_notes(std::move(notes));
    return grid;
  }
  const std::string bytes = file_bytes(path);  // once: a pipe cannot be opened again
  if (sensor != nullptr && !config.prior_sigma) {
    config.prior_sigma =
        default_prior_sigma(octomap_resolution_of_bytes(bytes, path.string()), *sensor);
  }
  return grid_from_octomap_bytes(bytes, config, path.string());
}

std::optional<Sensor> map_sensor(const BeliefGrid& grid) {
  const std::string& note = grid.notes().sensor;
  if (note.empty()) return std::nullopt;
  return parse_sensor_toml(note, "the map's sensor");
}

void check_map_name(const std::filesystem::path& path) {
  if (small_ending(path) == ".bt") {
    refuse(path.string() + ": .bt files can only be read; write a .ot file instead");
  }
  require_ending(path, "a map", {".vdb", ".ot"});
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
  grid.for_each_belief([&](Index3, const Belief&) { ++lost.beliefs; });
  lost.views = grid.views().size();
  lost.hazard_counters = !grid.hazard_counters().empty();
  lost.T_world_grid = !octomap_keeps_frame(grid);
  return lost;
}

}  // namespace viewgain
