// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain {

/// Over what length the readings of one place count together. Voxels that are finer than the
/// sensor's footprint hold too few readings each, however often the place was seen.
struct VIEWGAIN_EXPORT Pooling {
  int shift = 0;      ///< beliefs are added up in cubes of 2^shift voxels an edge, at most 3
  double length = 0;  ///< the cubes' edge or the footprint, whichever is longer [m]
};

/// The pooling of a map: its footprint is the median over the occupied voxels of a reading's sigma
/// across its ray, read off Λ_v / hits as if a voxel's readings came along one direction. The cubes
/// are as large as they can be under 1.42 footprints, so that a map with voxels of at least that
/// size pools nothing (shift 0, length the voxel size or the footprint). With a scale, 0 to 3, that
/// of the leaves of this scale, whose cubes are at least their cells. Costs about 20 ns an
/// occupied voxel. Never throws. Thread safe.
[[nodiscard]] VIEWGAIN_EXPORT Pooling pooling_of(const GridSnapshot& snapshot,
                                                 std::optional<int> scale = {});

}  // namespace viewgain
