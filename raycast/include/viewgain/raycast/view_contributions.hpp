// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain {

/// What one voxel adds to the gain of a view; see GainEvaluator::contributions().
struct VIEWGAIN_EXPORT VoxelContribution {
  Index3 voxel{};                          ///< of the map
  VoxelState state = VoxelState::unknown;  ///< unknown or occupied
  std::uint32_t rays = 0;                  ///< that end in it; surface, combined: that reach it
  /// Rays that are expected to end in it: as many as `rays` for the paper's gain, else the sum of
  /// their chances.
  double expected_rays = 0;
  double gain = 0;  ///< its task weight included, in the gain's unit
};

}  // namespace viewgain
