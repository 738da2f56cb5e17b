// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "obstacle_scene.hpp"
#include "ray_tile.hpp"

namespace viewgain::detail {

/// Shortens far[lane] [voxels] to where the tile's rays of these lanes meet an obstacle, there too.
/// Returns the lanes that meet one. Ranges of 0 meet nothing.
std::uint32_t cut_at_obstacles(const ObstacleScene& obstacles, const PoseFrame& frame,
                               const RayTile& rays, std::uint32_t lanes, float* far);

}  // namespace viewgain::detail
