// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

/// For each occupied voxel with readings, the information of the 27 voxels centred on it; in leaves
/// of a larger scale of the 27 cells. The combined gain finds its refinement by it
/// (apps/docs/guide/surface_gain.md). Immutable; thread safe.
class PooledSurface {
 public:
  /// n: how many of the 27 a flat piece of surface goes through, 3 × 3.
  static constexpr double kCells = 9;

  /// Cost: some microseconds for each leaf with readings.
  explicit PooledSurface(const GridSnapshot& snapshot);

  /// Of the snapshot's leaf with this number, by its scale. A belief's information is the sum over
  /// the 27 divided by n; its hits are no readings but m, how many of the 27 are occupied and have
  /// readings.
  [[nodiscard]] const BeliefBlock& block(std::size_t leaf) const { return blocks_[leaf]; }

  /// c_v: the chance that a surface goes through a voxel, of m.
  [[nodiscard]] static double chance(double m) { return std::min(1.0, m / kCells); }

 private:
  std::vector<BeliefBlock> blocks_;
};

}  // namespace viewgain::detail
