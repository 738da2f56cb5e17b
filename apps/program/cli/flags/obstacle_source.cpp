// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/obstacle_source.hpp"

#include "program/cli/values.hpp"
#include "viewgain/mesh/mesh_io.hpp"

namespace viewgain::app {

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
