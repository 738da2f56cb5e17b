// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/scene_sources.hpp"

#include <memory>

#include "program/cli/values.hpp"
#include "viewgain/formats/file_names.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {

bool is_hazard_file(const std::string& value) { return small_ending(value) == ".vdb"; }

HazardConfig hazard_source(const std::string& hazard, std::optional<double> object_size,
                           const BeliefGrid& grid) {
  if (object_size) check_positive("--object-size", *object_size);
  HazardConfig config;
  config.object_size = object_size;
  if (hazard.empty()) return config;
  if (is_hazard_file(hazard)) {
    config.volume = std::make_shared<const HazardConfig::Volume>(load_hazard_vdb(hazard, grid));
    return config;
  }
  if (!small_ending(hazard).empty() &&
      hazard.find_first_not_of("0123456789.+-eE") != std::string::npos) {
    refuse("--hazard " + hazard + ": must be a number or the path of a .vdb file");
  }
  const double rate = parse_numbers("--hazard", hazard, 1, 1)[0];
  check_at_least_0("--hazard", rate);
  return constant_hazard(rate, grid, object_size);
}

MeshPlacement placement_of(std::optional<double> size, const std::string& recenter,
                           const std::string& up) {
  MeshPlacement placement;
  placement.up = up == "x" ? UpAxis::x : up == "y" ? UpAxis::y : UpAxis::z;
  placement.center = recenter == "on";
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
      obstacles.meshes.push_back(read_mesh(value));
    } else {
      obstacles.boxes.push_back(parse_box("--obstacle", value));
    }
  }
  return obstacles;
}

}  // namespace viewgain::app
