// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "viewgain/core/box.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {

/// How well a part of the workspace is known (the paper's "selected parts").
struct VIEWGAIN_EXPORT RegionStatistics {
  std::uint64_t unknown = 0;   ///< voxels
  std::uint64_t free = 0;      ///< voxels
  std::uint64_t occupied = 0;  ///< voxels
  std::uint64_t hits = 0;      ///< readings that ended in the part, whatever its voxels are now
  double entropy_removed = 0;  ///< of its occupied voxels [nat, or m² for trace]
  /// Mean of √(tr(Λ_v⁻¹ + voxel²/12 I) / 3) over its occupied voxels with a belief [m]; NaN if
  /// there are none.
  double mean_sigma = 0;
};

/// Of the voxels whose centres lie in `region` (grid frame [m], half-open); what lies outside the
/// workspace is not counted; bounds may be infinite. One pass over the leaves that are not free.
/// Deterministic. Throws Error(invalid_argument) if a bound is NaN.
[[nodiscard]] VIEWGAIN_EXPORT RegionStatistics region_statistics(
    const BeliefGrid& grid, const Box& region, Criterion criterion = Criterion::log_diagonal);

}  // namespace viewgain
