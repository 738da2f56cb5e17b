// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

/// Boxes and meshes as one mesh, world frame [m]; they are not checked.
[[nodiscard]] TriangleMesh join_obstacles(const Obstacles& obstacles);

}  // namespace viewgain::detail
