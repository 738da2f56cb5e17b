// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene_data.hpp"

namespace viewgain::detail {

/// Throws Error(invalid_argument) for a vertex that is not finite, an index out of range or a box
/// inside out.
void check_obstacles(const Obstacles& obstacles);
/// The same, and for a support plane that is not finite.
void check_surroundings(const Surroundings& surroundings);

/// What is to be traced, but not how: boxes and tracing are still to be filled. Regions that the
/// snapshot shares with `before` (null: none), the scene that it was made from, are copied from
/// there. Throws Error(capacity).
[[nodiscard]] std::unique_ptr<SceneData> gather_scene(
    GridSnapshot snapshot, std::shared_ptr<const Surroundings> surroundings,
    std::shared_ptr<const HazardConfig> hazard, const SceneData* before);

/// Boxes and meshes as one mesh, world frame [m]; they are not checked.
[[nodiscard]] TriangleMesh join_obstacles(const Obstacles& obstacles);

/// Makes the primitives of data.snapshot. Regions that the snapshot shares with `before` (null:
/// none), the data of the scene that its snapshot was made from, are copied from there. Throws
/// Error(capacity).
void gather_primitives(SceneData& data, const SceneData* before);

}  // namespace viewgain::detail
