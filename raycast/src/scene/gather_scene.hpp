// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene_data.hpp"

namespace viewgain::detail {

/// Throws Error(invalid_argument) for a vertex that is not finite, an index out of range or a box
/// inside out.
void check_obstacles(const Obstacles& obstacles);
/// As above, and for a support plane that is not finite.
void check_surroundings(const Surroundings& surroundings);

/// The primitives of a scene; boxes and tracing are filled later. `before` (or null) is the scene
/// from whose snapshot this one was made; shared regions are copied from it. Throws
/// Error(capacity).
[[nodiscard]] std::unique_ptr<SceneData> gather_scene(
    GridSnapshot snapshot, std::shared_ptr<const Surroundings> surroundings,
    std::shared_ptr<const HazardConfig> hazard, const SceneData* before);

/// Boxes and meshes as one mesh, world frame [m], unchecked.
[[nodiscard]] TriangleMesh join_obstacles(const Obstacles& obstacles);

/// Makes the primitives of data.snapshot. `before` as above. Throws Error(capacity).
void gather_primitives(SceneData& data, const SceneData* before);

}  // namespace viewgain::detail
