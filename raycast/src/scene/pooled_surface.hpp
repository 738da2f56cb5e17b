// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

/// For each occupied voxel with readings, the information pooled from the 27 voxels centred on it.
/// Leaves of a larger scale pool 27 cells instead. The combined gain computes its refinement from
/// this (apps/docs/guide/surface_gain.md). Immutable; thread safe.
class PooledSurface {
 public:
  /// n: how many of the 27 a flat piece of surface passes through, 3 × 3.
  static constexpr double kCells = 9;

  /// Cost: some microseconds for each leaf with readings.
  explicit PooledSurface(const GridSnapshot& snapshot);

  /// The pooled beliefs of the snapshot's leaf with this index, at the leaf's scale. `information`
  /// is the sum over the 27, divided by n. `hits` does not count readings here: it is m, how many
  /// of the 27 are occupied and have readings.
  [[nodiscard]] const BeliefBlock& block(std::size_t leaf) const { return blocks_[leaf]; }

  /// c_v: the chance that a surface passes through a voxel, from its m.
  [[nodiscard]] static double chance(double m) { return std::min(1.0, m / kCells); }

 private:
  std::vector<BeliefBlock> blocks_;
};

}  // namespace viewgain::detail
