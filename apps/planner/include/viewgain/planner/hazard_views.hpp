// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// Generator name of candidates from hazard_views().
inline constexpr std::string_view kHazardViews = "hazard";

/// Views (T_world_camera) of the places where most new surface is expected behind known free space.
/// Returns at most `most` views: five per place, best place first.
///
/// Surface is expected behind the faces between free and unknown hazard cells (HazardField). The
/// expected area of a face is its own area times 1 - exp(-∫ h ds), with the hazard h. The integral
/// starts at the face and runs straight into unknown space, as long as surface there counts as new.
/// Faces in one cube with an edge of `spacing` [m] form a place; its position is their mean,
/// weighted by expected area. One view is at `distance` [m] in front of the place, and four are 30°
/// to the side. Image up is near +z.
///
/// A map without known surface has no places. Throws Error(invalid_argument) unless both lengths
/// are positive and finite. Deterministic, thread safe. Cost: 10 ms for 112³ hazard cells.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> hazard_views(const VoxelScene& scene,
                                                             double distance, double spacing,
                                                             std::size_t most);

/// Generator name of candidates from reachable_hazard_views().
inline constexpr std::string_view kReachViews = "reach_hazard";

/// At most `count` views (T_world_camera) of the same places from poses within `reach`, at 1, 1.6
/// or 2.5 times `distance` [m] and up to 75° to the side. A third of the views looks at their own
/// places, a third at the mean of all places, and a third in between. A view is omitted if 16
/// attempts find no reachable pose. Deterministic; thread safe if the reach's predicate is. Errors
/// and cost: those of hazard_views(), plus up to 16 · count calls of ReachRegion::contains().
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> reachable_hazard_views(const VoxelScene& scene,
                                                                       const ReachRegion& reach,
                                                                       double distance,
                                                                       double spacing,
                                                                       std::size_t count);

}  // namespace viewgain
