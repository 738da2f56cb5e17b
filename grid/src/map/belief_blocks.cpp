// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_blocks.hpp"

#include <algorithm>

#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"

namespace viewgain {

std::vector<BeliefBlockAt> belief_blocks(const BeliefGrid& grid) {
  const detail::BeliefMap& beliefs = detail::beliefs_of(grid);
  std::vector<std::uint64_t> keys;
  keys.reserve(beliefs.size());
  for (const auto& [key, block] : beliefs) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  const detail::BlockLattice lattice(grid.min_index(), grid.dims());
  std::vector<BeliefBlockAt> blocks;
  blocks.reserve(keys.size());
  for (const std::uint64_t key : keys) blocks.push_back({lattice.origin(key), beliefs.at(key)});
  return blocks;
}

std::shared_ptr<BeliefBlock> detail::reshaped(const BeliefBlock* block, const LeafMask& mask) {
  auto result = std::make_shared<BeliefBlock>();
  result->mask = mask;
  if (block != nullptr) result->scale = block->scale;
  result->beliefs.reserve(count_bits(mask));
  for_each_bit(mask, [&](unsigned offset) {
    const Belief* old = block != nullptr ? block->find(offset) : nullptr;
    result->beliefs.push_back(old != nullptr ? *old : Belief{});
  });
  return result;
}

}  // namespace viewgain
