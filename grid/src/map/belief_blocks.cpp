// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_blocks.hpp"

#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {

std::shared_ptr<BeliefBlock> reshaped(const BeliefBlock* block, const LeafMask& mask) {
  auto result = std::make_shared<BeliefBlock>();
  result->mask = mask;
  result->beliefs.reserve(count_bits(mask));
  for_each_bit(mask, [&](unsigned offset) {
    const Belief* old = block != nullptr ? block->find(offset) : nullptr;
    result->beliefs.push_back(old != nullptr ? *old : Belief{});
  });
  return result;
}

}  // namespace viewgain::detail
