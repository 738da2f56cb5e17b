// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain {

/// What one voxel adds to the gain of a view; see GainEvaluator::contributions().
struct VIEWGAIN_EXPORT VoxelContribution {
  Index3 voxel{};
  VoxelState state = VoxelState::unknown;  ///< unknown or occupied
  std::uint32_t rays = 0;                  ///< that end in it
  double gain = 0;                         ///< its task weight included [nat, or m² for trace]
};

}  // namespace viewgain
