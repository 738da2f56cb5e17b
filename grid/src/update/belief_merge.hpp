// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "hit.hpp"
#include "readings.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

/// The block (may be null) after the hits, all its own, in their order: Λ_v += Λ_r (the paper's eq.
/// 4), η_v += Λ_r (p_r - centre), each sum rounded to single precision. A new block: snapshots may
/// hold the old one.
[[nodiscard]] std::shared_ptr<const BeliefBlock> with_hits(
    const BeliefBlock* block, std::span<const Hit> hits, const Readings& pixels,
    const Pose& T_grid_readings, Index3 origin, double voxel_size, int scale);

}  // namespace viewgain::detail
