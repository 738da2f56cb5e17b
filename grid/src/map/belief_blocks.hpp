// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "viewgain/grid/belief.hpp"

namespace viewgain::detail {

/// A copy of `block` (may be null) with room, and zero beliefs, for the voxels of `mask` that it
/// lacks; those that `mask` lacks are dropped. Blocks are never changed in place: snapshots may
/// hold the old one.
[[nodiscard]] std::shared_ptr<BeliefBlock> reshaped(const BeliefBlock* block, const LeafMask& mask);

}  // namespace viewgain::detail
