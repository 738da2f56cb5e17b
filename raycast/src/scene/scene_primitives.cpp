// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "gather_scene.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kMaxPrimitives = std::size_t{1} << 23U;

// The tightest box around the set bits of a leaf.
PrimitiveBox tight_box(const LeafMask& mask, const std::array<float, 3>& origin) {
  unsigned x_min = 8, x_max = 0;
  std::uint64_t any = 0;
  for (unsigned x = 0; x < 8; ++x) {
    if (mask[x] == 0) continue;
    x_min = std::min(x_min, x);
    x_max = x;
    any |= mask[x];
  }
  // Bits of `any` are y << 3 | z: fold the bytes for z, take first and last byte for y.
  const auto y_min = static_cast<unsigned>(std::countr_zero(any)) / 8U;
  const auto y_max = 7U - static_cast<unsigned>(std::countl_zero(any)) / 8U;
  std::uint64_t fold = any | any >> 32U;
  fold |= fold >> 16U;
  const auto z_bits = static_cast<std::uint8_t>(fold | fold >> 8U);
  const auto z_min = static_cast<unsigned>(std::countr_zero(z_bits));
  const auto z_max = 7U - static_cast<unsigned>(std::countl_zero(z_bits));
  return {{origin[0] + static_cast<float>(x_min), origin[1] + static_cast<float>(y_min),
           origin[2] + static_cast<float>(z_min)},
          {origin[0] + static_cast<float>(x_max + 1U), origin[1] + static_cast<float>(y_max + 1U),
           origin[2] + static_cast<float>(z_max + 1U)},
          x_min << 6U | y_min << 3U | z_min};
}

bool is_whole_block(const VoxelBox& tile) {
  const auto aligned = [](std::int32_t min, std::int32_t max) {
    return max - min == 8 && (min & 7) == 0;
  };
  return aligned(tile.min.x, tile.max.x) && aligned(tile.min.y, tile.max.y) &&
         aligned(tile.min.z, tile.max.z);
}

bool is_wholly_unknown(const GridSnapshot::Leaf& leaf) {
  std::uint64_t non_free = ~std::uint64_t{0}, occupied = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    non_free &= leaf.non_free[i];
    occupied |= leaf.occupied[i];
  }
  return non_free == ~std::uint64_t{0} && occupied == 0;
}

/// Makes the three kinds of primitives, region by region. Leaves come first, so the other two kinds
/// are collected and appended.
class Gatherer {
 public:
  Gatherer(SceneData& data, const SceneData* before)
      : data_(data), snapshot_(data.snapshot), before_(before) {
    const std::size_t leaves = snapshot_.leaves.size(), most = leaves + snapshot_.tiles.size();
    data.masks.reserve(leaves);
    data.leaf_source.reserve(leaves);
    data.has_occupied.reserve(leaves);
    data.boxes.reserve(most);
    data.block_keys.reserve(most);
    data.regions.reserve(snapshot_.regions.size() + 1);
    blocks_.reserve(snapshot_.tiles.size());
    block_keys_.reserve(snapshot_.tiles.size());
  }

  void run() {
    const std::size_t large_tiles =
        snapshot_.regions.empty() ? snapshot_.tiles.size() : snapshot_.tiles_of(0)[0];
    // All of them become boxes, even one that the workspace cuts to a single block, because it is
    // in no region.
    for (std::size_t i = 0; i < large_tiles; ++i) add_box(snapshot_.tiles[i]);
    std::size_t earlier = 0;
    for (std::size_t i = 0; i < snapshot_.regions.size(); ++i) {
      note_region();
      const GridSnapshot::Region& region = snapshot_.regions[i];
      if (before_ != nullptr && snapshot_.is_shared(region)) {
        const auto& regions = before_->snapshot.regions;
        while (earlier < regions.size() && regions[earlier].number < region.number) ++earlier;
        if (earlier < regions.size() && regions[earlier].number == region.number) {
          copy_region(earlier, region);
          continue;
        }
      }
      const auto [leaf, leaf_end] = snapshot_.leaves_of(i);
      for (std::uint32_t l = leaf; l < leaf_end; ++l) add_leaf(l);
      const auto [tile, tile_end] = snapshot_.tiles_of(i);
      for (std::uint32_t t = tile; t < tile_end; ++t) add_tile(snapshot_.tiles[t]);
    }
    note_region();

    data_.leaf_count = data_.masks.size();
    data_.block_count = data_.leaf_count + blocks_.size();
    data_.boxes.insert(data_.boxes.end(), blocks_.begin(), blocks_.end());
    data_.boxes.insert(data_.boxes.end(), larger_.begin(), larger_.end());
    data_.block_keys.insert(data_.block_keys.end(), block_keys_.begin(), block_keys_.end());
    if (data_.boxes.size() > kMaxPrimitives) {
      throw Error(ErrorCode::capacity, "the map has " + std::to_string(data_.boxes.size()) +
                                           " blocks of voxels that are not free; the maximum is " +
                                           std::to_string(kMaxPrimitives));
    }
  }

 private:
  void note_region() {
    data_.regions.push_back({static_cast<std::uint32_t>(data_.masks.size()),
                             static_cast<std::uint32_t>(blocks_.size()),
                             static_cast<std::uint32_t>(larger_.size())});
  }

  void copy_region(std::size_t earlier, const GridSnapshot::Region& region) {
    const SceneData& from = *before_;
    const SceneRegion &first = from.regions[earlier], &last = from.regions[earlier + 1];
    const auto append = [](auto& to, const auto& list, std::size_t begin, std::size_t end) {
      to.insert(to.end(), list.begin() + static_cast<std::ptrdiff_t>(begin),
                list.begin() + static_cast<std::ptrdiff_t>(end));
    };
    append(data_.masks, from.masks, first.leaf, last.leaf);
    append(data_.boxes, from.boxes, first.leaf, last.leaf);
    append(data_.block_keys, from.block_keys, first.leaf, last.leaf);
    append(data_.has_occupied, from.has_occupied, first.leaf, last.leaf);
    // Unsigned differences wrap around, and back when added.
    const std::uint32_t shift = region.first_leaf - from.snapshot.regions[earlier].first_leaf;
    for (std::size_t i = first.leaf; i < last.leaf; ++i) {
      data_.leaf_source.push_back(from.leaf_source[i] + shift);
    }
    append(blocks_, from.boxes, from.leaf_count + first.block, from.leaf_count + last.block);
    append(block_keys_, from.block_keys, from.leaf_count + first.block,
           from.leaf_count + last.block);
    append(larger_, from.boxes, from.block_count + first.box, from.block_count + last.box);
  }

  void add_leaf(std::uint32_t number) {
    const GridSnapshot::Leaf& leaf = snapshot_.leaves[number];
    if (is_wholly_unknown(leaf)) {
      add_block(leaf.origin);
      return;
    }
    TraceMask mask;
    static_assert(sizeof(mask.words) == sizeof(leaf.non_free) &&
                  std::endian::native == std::endian::little);
    std::memcpy(mask.words.data(), leaf.non_free.data(), sizeof(mask.words));
    data_.masks.push_back(mask);
    data_.boxes.push_back(tight_box(leaf.non_free, relative(leaf.origin)));
    data_.block_keys.push_back(key_of(leaf.origin));
    data_.leaf_source.push_back(number);
    data_.has_occupied.push_back(leaf.occupied != LeafMask{} ? 1 : 0);
  }

  void add_tile(const VoxelBox& tile) {
    if (is_whole_block(tile)) {
      add_block(tile.min);
    } else {
      add_box(tile);
    }
  }

  // Splits a tile into pieces whose offsets fit.
  void add_box(const VoxelBox& tile) {
    constexpr std::int32_t kEdge = kMaxBoxEdge;
    const Index3 &min = tile.min, &max = tile.max;
    for (std::int32_t x = min.x; x < max.x; x += kEdge) {
      for (std::int32_t y = min.y; y < max.y; y += kEdge) {
        for (std::int32_t z = min.z; z < max.z; z += kEdge) {
          const auto low = relative({x, y, z});
          const auto high = relative(
              {std::min(x + kEdge, max.x), std::min(y + kEdge, max.y), std::min(z + kEdge, max.z)});
          larger_.push_back({{low[0], low[1], low[2]}, {high[0], high[1], high[2]}, 0});
        }
      }
    }
  }

  void add_block(const Index3& origin) {
    const auto low = relative(origin);
    blocks_.push_back({{low[0], low[1], low[2]}, {low[0] + 8.0F, low[1] + 8.0F, low[2] + 8.0F}, 0});
    block_keys_.push_back(key_of(origin));
  }

  [[nodiscard]] std::uint64_t key_of(const Index3& origin) const {
    return data_.block_of(origin.x >> 3, origin.y >> 3, origin.z >> 3) << 9U;
  }
  [[nodiscard]] std::array<float, 3> relative(const Index3& voxel) const {
    const Index3& base = snapshot_.min_index;
    return {static_cast<float>(voxel.x - base.x), static_cast<float>(voxel.y - base.y),
            static_cast<float>(voxel.z - base.z)};
  }

  SceneData& data_;
  const GridSnapshot& snapshot_;
  const SceneData* before_;
  std::vector<PrimitiveBox> blocks_, larger_;
  std::vector<std::uint64_t> block_keys_;
};

}  // namespace

void gather_primitives(SceneData& data, const SceneData* before) { Gatherer(data, before).run(); }

}  // namespace viewgain::detail
