// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/sensed_map.hpp"

#include <cstdio>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "program/cli/values.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain::app {
namespace {

std::string readings_of(Sensor sensor) {
  sensor.name.clear();
  sensor.body_size.reset();
  sensor.T_flange_camera.reset();
  return sensor_toml(sensor);
}

// Of their files the first line that differs: "fx = 585.0 there, fx = 525.0 here".
std::string difference(const Sensor& there, const Sensor& here) {
  std::istringstream of_there(readings_of(there)), of_here(readings_of(here));
  std::string a, b;
  do {
    std::getline(of_there, a);
    std::getline(of_here, b);
  } while (a == b && of_there && of_here);
  const auto shown = [](const std::string& line) { return line.substr(0, line.find("  #")); };
  return shown(a) + " there, " + shown(b) + " here";
}

}  // namespace

bool is_same_sensor(const Sensor& a, const Sensor& b) { return readings_of(a) == readings_of(b); }

bool warn_of_other_sensor(const std::string& path, const MapOfSensor& map, const Sensor& sensor) {
  if (!map.sensor || is_same_sensor(*map.sensor, sensor)) return false;
  std::fprintf(stderr, "viewgain: warning: the readings in %s come from %s, not from this %s: %s\n",
               path.c_str(), map.sensor->name.c_str(), sensor.name.c_str(),
               difference(*map.sensor, sensor).c_str());
  return true;
}

SensedMap load_sensed_map(const std::string& path, const std::string& sensor_flag,
                          const ExecConfig& exec) {
  std::optional<Sensor> asked;
  if (!sensor_flag.empty()) asked = load_sensor(sensor_flag);
  MapOfSensor map = load_map_of_sensor(path, asked ? &*asked : nullptr, {}, exec);
  if (!asked && !map.sensor) {
    refuse(path + ": does not say which sensor its readings come from; give --sensor");
  }
  if (asked) warn_of_other_sensor(path, map, *asked);
  if (is_octomap(path)) {
    std::fprintf(stderr,
                 "viewgain: note: %s has states alone: known surface counts as never measured "
                 "(--gain surface leaves that out), and views that were taken are not known\n",
                 path.c_str());
  }
  return {std::move(map.grid), asked ? std::move(*asked) : std::move(*map.sensor)};
}

void require_known(const BeliefGrid& grid, const std::string& path) {
  if (grid.statistics().unknown < grid.voxel_count()) return;
  refuse(path +
         ": all of it is unknown, no reading is in it; was it made with the wrong "
         "workspace, scale or poses (world to camera)?");
}

}  // namespace viewgain::app
