// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "readings.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain::detail {

/// A reading and the voxel that encloses it.
struct Hit {
  std::uint64_t block = 0;  ///< BlockLattice::key
  std::uint32_t pixel = 0;
  std::uint32_t offset = 0;  ///< in the block
};

/// Orders the hits by block, keeping their order within each block. `scratch` is working space.
void sort_by_block(std::vector<Hit>& hits, std::vector<Hit>& scratch);

/// The block with one voxel's belief replaced, or taken out; null if nothing is left.
[[nodiscard]] std::shared_ptr<const BeliefBlock> with_belief(const BeliefBlock* block,
                                                             unsigned offset, const Belief* belief);

/// The block (may be null) after the hits, all its own, in their order: Λ_v += Λ_r (the paper's eq.
/// 4), η_v += Λ_r (p_r - centre), each sum rounded to single precision. A new block: snapshots may
/// hold the old one.
[[nodiscard]] std::shared_ptr<const BeliefBlock> with_hits(const BeliefBlock* block,
                                                           std::span<const Hit> hits,
                                                           const Readings& pixels,
                                                           const Pose& T_grid_readings,
                                                           Index3 origin, double voxel_size);

}  // namespace viewgain::detail
