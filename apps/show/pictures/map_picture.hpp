// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "show/pictures/picture_parts.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// As many cubes as a picture has room for.
inline constexpr std::size_t kMaxCubes = 400'000;

/// Cubes of one lattice in the grid's frame; cube i reaches from side * at[i] to side * (at[i] + 1)
/// [m].
struct LatticeCubes {
  std::vector<Index3> at;  ///< rising
  double side = 0;         ///< [m]
};

/// The occupied voxels as at most `most` cubes: two by two by two become one until they are few
/// enough.
[[nodiscard]] LatticeCubes occupied_cubes(const GridSnapshot& snapshot, std::size_t most);

/// A map's occupied voxels as little grey cubes in the outline of its workspace. The same picture
/// for any number of threads.
[[nodiscard]] RgbImage map_picture(const GridSnapshot& snapshot, const Viewer& viewer,
                                   const ExecConfig& exec);

/// A picture of one view, 1280x960 px: the map's occupied voxels as little grey cubes, the view's
/// frustum, and the voxels where its rays end, unknown ones orange, occupied ones blue; by the
/// surface and combined gain unknown voxels in which it may find surface, the larger the likelier;
/// seen from a place that shows both. Throws Error(invalid_argument) unless the pose is rigid
/// (1e-3).
[[nodiscard]] RgbImage score_picture(const GainEvaluator& evaluator, const Sensor& sensor,
                                     const Pose& T_world_camera, const ExecConfig& exec);

}  // namespace viewgain::app
