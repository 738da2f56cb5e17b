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

/// The generator of candidates that hazard_views() made.
inline constexpr std::string_view kHazardViews = "hazard";

/// Views (T_world_camera) of the places where most new surface is to be expected behind what is
/// seen to be free, at most `most` of them, in steps of five a place, the best place first.
///
/// Where free space ends at unknown space that the hazard's distances reach, the area to be
/// expected behind a face between two hazard cells is that of the face times 1 - exp(-∫ h ds)
/// straight into the unknown, as far as what would be found counts as new. Faces are gathered in
/// cubes of `spacing` [m]. A place is the mean of a cube's faces, by area to be expected. One view
/// stands at `distance` [m] from it, where the faces look to, four by 30° beside; image up is near
/// +z.
///
/// A map without evidence of surface has no such place. Throws Error(invalid_argument) unless both
/// lengths are positive and finite. Deterministic, thread safe. Costs 10 ms for 112³ hazard cells.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> hazard_views(const VoxelScene& scene,
                                                             double distance, double spacing,
                                                             std::size_t most);

/// Who made candidates of reachable_hazard_views().
inline constexpr std::string_view kReachViews = "reach_hazard";

/// Views (T_world_camera) of the same places from where `reach` lets the camera be, at most
/// `count`: places in turn by their area, each from 1, 1.6 or 2.5 times `distance` [m] and up to
/// 75° beside where its faces look to. A third looks at its place, a third at the mean of all
/// places, a third between. A view for which 16 tries find no reachable pose is omitted.
/// Deterministic; thread safe if the reach's predicate is. Throws and costs as hazard_views(), and
/// up to 16 `count` calls of ReachRegion::contains().
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> reachable_hazard_views(const VoxelScene& scene,
                                                                       const ReachRegion& reach,
                                                                       double distance,
                                                                       double spacing,
                                                                       std::size_t count);

}  // namespace viewgain
