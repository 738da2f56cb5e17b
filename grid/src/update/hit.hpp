// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "viewgain/grid/belief.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

/// A reading and the voxel that it counts for.
struct Hit {
  std::uint64_t block = 0;  ///< BlockLattice::key
  std::uint32_t pixel = 0;
  std::uint32_t offset = 0;  ///< in the block
};

/// The hits of one block: [begin, end) of the sorted hits, and where its beliefs are kept.
struct HitBlock {
  std::uint64_t key = 0;
  std::uint32_t begin = 0, end = 0;
  std::shared_ptr<const BeliefBlock>* beliefs = nullptr;
};

}  // namespace viewgain::detail
