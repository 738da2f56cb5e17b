// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Sets and resamples voxels by the cells of their leaves.
#include "leaf_scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "belief_blocks.hpp"
#include "belief_sum.hpp"
#include "grid_layout.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

using namespace detail;

void check_value(const GridStorage& s, const BeliefGrid::VoxelValue& value) {
  const Index3& v = value.voxel;
  if (!s.lattice.contains(v)) {
    refuse("voxel (" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " +
           std::to_string(v.z) + ") lies outside the workspace");
  }
  if (std::isnan(value.log_odds)) refuse("the log-odds must not be NaN");
  if (!value.belief) return;
  const std::string fault = fault_of_belief(*value.belief, s.voxel_size);
  if (!fault.empty()) refuse("the belief " + fault);
}

/// A value and the key of its block.
using KeyedValue = std::pair<std::uint64_t, const BeliefGrid::VoxelValue*>;

/// A uniform block that is not occupied has no scale unless it has beliefs.
void drop_if_idle(GridStorage& s, std::uint64_t key) {
  const CodeLeaf* leaf = s.tree.probeConstLeaf(to_coord(s.lattice.origin(key)));
  const bool is_uniform =
      leaf != nullptr &&
      GridStorage::make_leaf(to_index(leaf->origin()), leaf->buffer().data()) == nullptr;
  if (!s.is_held(key) || (is_uniform && !s.beliefs.contains(key))) s.scales.erase(key);
}

/// Sets voxels of one block; the last value of duplicates counts.
void set_in_block(GridStorage& s, std::span<const KeyedValue> values) {
  const std::uint64_t key = values.front().first;
  s.mark_changed(key);
  const int scale = s.scale(key);
  const BeliefBlock* block = s.find_beliefs(key);
  LeafMask mask = block != nullptr ? block->mask : LeafMask{};
  for (const auto& [_, value] : values) {
    const std::uint8_t code = log_odds_code(value->log_odds);
    const unsigned offset = cell_offset(block_offset(value->voxel), scale);
    for_each_in_cell(offset, scale, [&](unsigned at) {
      const openvdb::Coord voxel = to_coord(offset_voxel(s.lattice.origin(key), at));
      if (is_non_free(code)) {
        s.tree.setValueOn(voxel, code);
      } else {
        s.tree.setValueOff(voxel, code);
      }
    });
    const std::uint64_t bit = std::uint64_t{1} << (offset & 63U);
    std::uint64_t& word = mask[offset >> 6U];
    word = value->belief ? word | bit : word & ~bit;
  }
  s.fold_cell(key);
  if (mask == LeafMask{}) {
    s.beliefs.erase(key);
    if (scale > 0) drop_if_idle(s, key);
    return;
  }
  auto changed = reshaped(block, mask);
  changed->scale = static_cast<std::uint8_t>(scale);
  for (const auto& [_, value] : values) {
    const unsigned offset = cell_offset(block_offset(value->voxel), scale);
    // A later value of the same voxel can have none.
    if (value->belief && test_bit(mask, offset)) {
      changed->beliefs[changed->rank(offset)] = definite(*value->belief);
    }
  }
  s.beliefs[key] = std::move(changed);
}

// Offset of the smaller cell that contains, or is nearest to, the mean of a cell's readings.
unsigned mean_offset(const Belief& belief, unsigned lowest, int from, int to, double voxel_size) {
  const auto& v = belief.information_vector;
  const Eigen::Vector3d mean =
      belief.information_matrix().inverse() * Eigen::Vector3d(v[0], v[1], v[2]) / voxel_size;
  const int edge = 1 << from;
  unsigned offset = lowest;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double at = std::floor(0.5 * edge + (std::isfinite(mean[axis]) ? mean[axis] : 0.0));
    offset += static_cast<unsigned>(std::clamp(at, 0.0, edge - 1.0)) << 3U * (2U - axis);
  }
  return cell_offset(offset, to);
}

// A cell with a belief is known: one of its voxels is.
void coarsen_codes(int to, const LeafMask& believed, std::uint8_t* codes) {
  for (unsigned lowest = 0; lowest < kBlockVoxels; ++lowest) {
    if (cell_offset(lowest, to) != lowest) continue;
    std::uint8_t most = 0, least = kMaxCode;
    for_each_in_cell(lowest, to, [&](unsigned offset) {
      most = std::max(most, codes[offset]);
      least = std::min(least, codes[offset]);
    });
    const bool is_known = is_occupied(most) || least != kUnknownCode || test_bit(believed, lowest);
    const std::uint8_t code = is_known ? most : kUnknownCode;
    for_each_in_cell(lowest, to, [&](unsigned offset) { codes[offset] = code; });
  }
}

}  // namespace

int detail::scale_of(const BeliefGrid& grid, std::uint64_t key) {
  return GridAccess::storage(grid).scale(key);
}
bool detail::has_scales(const BeliefGrid& grid) {
  return !GridAccess::storage(grid).scales.empty();
}
bool detail::is_held(const BeliefGrid& grid, std::uint64_t key) {
  return GridAccess::storage(grid).is_held(key);
}
void detail::set_scale(BeliefGrid& grid, std::uint64_t key, int scale) {
  set_scale(GridAccess::storage(grid), key, scale);
}

int detail::fitting_scale(const BlockLattice& lattice, Index3 origin, int scale) {
  if (lattice.covers(origin, kBlockSize)) return scale;
  const VoxelBox part = clipped(lattice, origin, kBlockSize);
  const std::int32_t faces =
      part.min.x | part.min.y | part.min.z | part.max.x | part.max.y | part.max.z;
  while ((faces & ((1 << scale) - 1)) != 0) --scale;
  return scale;
}

void detail::resample_block(Index3 origin, double voxel_size, int from, int to, std::uint8_t* codes,
                            std::shared_ptr<const BeliefBlock>& beliefs) {
  std::shared_ptr<BeliefBlock> fresh;
  LeafMask emptied{};  // cells that were occupied and gave their belief away
  if (beliefs != nullptr) {
    std::array<std::uint16_t, kBlockVoxels> place{};  // 1 + index among the sums
    std::vector<BeliefSum> sums;
    LeafMask mask{};
    std::size_t rank = 0;
    for_each_bit(beliefs->mask, [&](unsigned offset) {
      const Belief& belief = beliefs->beliefs[rank++];
      const unsigned at =
          to > from ? cell_offset(offset, to) : mean_offset(belief, offset, from, to, voxel_size);
      if (to < from && is_occupied(codes[offset])) {
        for_each_in_cell(offset, from, [&](unsigned o) { set_bit(emptied, o); });
        for_each_in_cell(at, to, [&](unsigned o) { emptied[o >> 6U] &= ~(1ULL << (o & 63U)); });
      }
      if (place[at] == 0) {
        sums.emplace_back();
        place[at] = static_cast<std::uint16_t>(sums.size());
        set_bit(mask, at);
      }
      sums[place[at] - 1U].add(belief,
                               voxel_center(offset_voxel(origin, offset), voxel_size, from) -
                                   voxel_center(offset_voxel(origin, at), voxel_size, to));
    });
    fresh = std::make_shared<BeliefBlock>();
    fresh->mask = mask;
    fresh->scale = static_cast<std::uint8_t>(to);
    fresh->beliefs.reserve(sums.size());
    for_each_bit(mask,
                 [&](unsigned at) { fresh->beliefs.push_back(sums[place[at] - 1U].rounded()); });
  }
  if (to > from) coarsen_codes(to, fresh != nullptr ? fresh->mask : LeafMask{}, codes);
  for_each_bit(emptied, [&](unsigned offset) { codes[offset] = kUnknownCode; });
  if (fresh != nullptr) beliefs = std::move(fresh);
}

void detail::set_scale(GridStorage& s, std::uint64_t key, int scale) {
  const Index3 origin = s.lattice.origin(key);
  const int from = s.scale(key);
  scale = fitting_scale(s.lattice, origin, scale);
  if (scale == from) return;
  const auto held = s.beliefs.find(key);
  if (!s.is_held(key)) {
    s.put_scale(key, scale);
    return;
  }
  const CodeLeaf* leaf = s.tree.probeConstLeaf(to_coord(origin));
  std::array<std::uint8_t, kBlockVoxels> codes;
  if (leaf != nullptr) {
    std::memcpy(codes.data(), leaf->buffer().data(), codes.size());
  } else {
    codes.fill(s.tree.getValue(to_coord(origin)));
  }
  std::shared_ptr<const BeliefBlock> beliefs = held != s.beliefs.end() ? held->second : nullptr;
  resample_block(origin, s.voxel_size, from, scale, codes.data(), beliefs);
  auto made = GridStorage::make_leaf(origin, codes.data());
  s.put_scale(key, scale);
  s.put_leaf(origin, std::move(made), codes[0]);
  s.fold_cell(key);
  if (held != s.beliefs.end()) held->second = std::move(beliefs);
  s.mark_changed(key);
}

std::vector<std::uint64_t> detail::held_blocks(const GridStorage& s) {
  std::vector<std::uint64_t> keys;
  visit_blocks(
      s, [&](const CodeLeaf&, Index3 origin) { keys.push_back(s.lattice.key(origin)); },
      [&](Index3 origin, int, std::uint8_t code) {
        if (is_occupied(code)) keys.push_back(s.lattice.key(origin));
      });
  for (const auto& [key, block] : s.beliefs) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

void detail::drop_idle_scales(GridStorage& s) {
  std::erase_if(s.scales, [&](const auto& entry) { return !s.is_held(entry.first); });
}

void BeliefGrid::set(Index3 voxel, float log_odds, const std::optional<Belief>& belief) {
  const BeliefGrid::VoxelValue value{voxel, log_odds, belief};
  check_value(*storage_, value);
  const KeyedValue keyed(storage_->lattice.key(voxel), &value);
  set_in_block(*storage_, std::span(&keyed, 1));
  ++storage_->time;
}

void BeliefGrid::set(std::span<const BeliefGrid::VoxelValue> voxels) {
  GridStorage& s = *storage_;
  for (const BeliefGrid::VoxelValue& value : voxels) check_value(s, value);

  // By block, so that its beliefs are copied once.
  std::vector<KeyedValue> by_block;
  by_block.reserve(voxels.size());
  for (const BeliefGrid::VoxelValue& value : voxels)
    by_block.emplace_back(s.lattice.key(value.voxel), &value);
  std::stable_sort(by_block.begin(), by_block.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto first = by_block.begin(), last = first; first != by_block.end(); first = last) {
    last = std::find_if(first, by_block.end(),
                        [&](const auto& value) { return value.first != first->first; });
    set_in_block(s, std::span(first, last));
  }
  ++s.time;
}

int BeliefGrid::scale(Index3 voxel) const {
  return storage_->lattice.contains(voxel) ? storage_->scale(storage_->lattice.key(voxel)) : 0;
}

std::uint64_t BeliefGrid::resample(const Box& region, int scale) {
  GridStorage& s = *storage_;
  const VoxelBox range = voxels_in(*this, region);
  if (scale < 0 || scale > kMaxScale) {
    refuse("the scale must be in 0.." + std::to_string(kMaxScale) + ", not " +
           std::to_string(scale));
  }
  std::uint64_t changed = 0;
  for (const std::uint64_t key : held_blocks(s)) {
    const Index3 origin = s.lattice.origin(key);
    if (range.intersection(VoxelBox::from_dims(origin, {kBlockSize, kBlockSize, kBlockSize}))
            .volume() == 0) {
      continue;
    }
    const int before = s.scale(key);
    set_scale(s, key, scale);
    changed += s.scale(key) != before ? 1U : 0U;
  }
  drop_idle_scales(s);
  if (changed > 0) ++s.time;
  return changed;
}

}  // namespace viewgain
