// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

/// What is known of the surface at each occupied voxel with readings, from its own and from those
/// of the voxels around: what the combined gain's refinement is counted from
/// (docs/guide/surface_gain.md). Immutable; thread safe.
class PooledSurface {
 public:
  /// n: how many voxels of a piece of surface a delivered point pools, 3 × 3.
  static constexpr double kVoxels = 9;

  /// Cost: 27 voxels for each occupied one.
  explicit PooledSurface(const GridSnapshot& snapshot);

  /// By the snapshot's leaves. A belief's information is that of the 27 voxels round its voxel over
  /// n, Λ̄_v; its hits are the number m of these voxels that are occupied and have readings.
  [[nodiscard]] const BeliefBlock& block(std::size_t leaf) const { return blocks_[leaf]; }

  /// The chance that a surface goes through a voxel that has m voxels with readings round it.
  [[nodiscard]] static double chance(double m) { return std::min(1.0, m / kVoxels); }

 private:
  std::vector<BeliefBlock> blocks_;
};

}  // namespace viewgain::detail
