// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/map_file.hpp"

#include <map>
#include <sstream>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// In the metadata of a .vdb.
constexpr const char* kSensorNote = "sensor";  // sensor_toml()
constexpr const char* kFramesNote = "frames";  // frame_identity(), a line each

std::set<std::string> frames_of_note(const std::string& note, const std::string& file) {
  constexpr std::size_t kDigits = 16;
  std::set<std::string> frames;
  std::istringstream lines(note);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < kDigits + 2 || line.find_first_not_of("0123456789abcdef") != kDigits ||
        line[kDigits] != ' ') {
      throw Error(ErrorCode::format,
                  file + ": the note of its frames holds " + viewgain::quoted(line));
    }
    frames.insert(line);
  }
  return frames;
}

}  // namespace

bool is_octomap(const std::filesystem::path& path) {
  return small_ending(path) == ".ot" || small_ending(path) == ".bt";
}

BeliefGrid load_map(const std::filesystem::path& path, const Sensor* sensor, OctomapConfig config,
                    const ExecConfig& exec) {
  return load_map_of_sensor(path, sensor, config, exec).grid;
}

MapOfSensor load_map_of_sensor(const std::filesystem::path& path, const Sensor* sensor,
                               OctomapConfig config, const ExecConfig& exec) {
  if (!is_octomap(path)) {
    std::map<std::string, std::string> notes;
    MapOfSensor result{load_vdb(path, &notes, exec), std::nullopt};
    if (const auto note = notes.find(kSensorNote); note != notes.end()) {
      result.sensor = parse_sensor_toml(note->second, path.string());
    }
    if (const auto note = notes.find(kFramesNote); note != notes.end()) {
      result.frames = frames_of_note(note->second, path.string());
    }
    return result;
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

VdbWriteConfig noting_frames(const std::set<std::string>& frames, VdbWriteConfig config) {
  if (frames.empty()) return config;
  std::string& note = config.notes[kFramesNote];
  note.clear();
  for (const std::string& frame : frames) note += frame + "\n";
  return config;
}

void check_map_name(const std::filesystem::path& path) {
  if (small_ending(path) == ".bt") {
    refuse(path.string() + ": .bt files are read but not written; .ot ones are");
  }
  require_ending(path, "a map to write", {".vdb", ".ot"});
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
