// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {

/// Is a value of --obstacle a mesh file, and not the numbers of a box?
[[nodiscard]] bool is_obstacle_file(const std::string& value);

/// What --obstacle says: each value a mesh file (OFF, OBJ, STL, PLY) or a box x0,y0,z0,x1,y1,z1,
/// in the world's frame [m]. Throws Error(invalid_argument), naming the flag, for a box that is
/// none, and as read_mesh().
[[nodiscard]] Obstacles obstacles_of(const std::vector<std::string>& values);

inline constexpr const char* kObstacleHelp =
    "mesh file, or x0,y0,z0,x1,y1,z1: a known obstacle in the world's frame [m], which blocks rays "
    "and gains nothing; may be repeated";

}  // namespace viewgain::app
