// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "block_masks.hpp"

#include <array>
#include <bit>

#include "viewgain/grid/belief.hpp"

namespace viewgain::detail {

BlockMasks::BlockMasks(const GridSnapshot& snapshot, const VoxelBox& cells, int shift)
    : shift_(shift),
      cells_(cells),
      rows_y_(static_cast<std::size_t>(cells.max.y - cells.min.y)),
      rows_z_(static_cast<std::size_t>(cells.max.z - cells.min.z)),
      workspace_(VoxelBox::from_dims(snapshot.min_index, snapshot.dims)) {
  known_ = std::make_unique<Cell[]>(cells.volume());
  const VoxelBox voxels{lowest(cells.min), lowest(cells.max)};
  is_cut_ = voxels.intersection(workspace_).volume() != voxels.volume();
  low_ = {voxels.min.x >> 3, voxels.min.y >> 3, voxels.min.z >> 3};
  const auto extent = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::size_t>(((to - 1) >> 3) - from + 1);
  };
  size_y_ = extent(low_.y, voxels.max.y);
  size_z_ = extent(low_.z, voxels.max.z);
  blocks_.assign(extent(low_.x, voxels.max.x) * size_y_ * size_z_, kFree);
  // Tiles are whole blocks, up to the workspace's faces.
  for (const VoxelBox& tile : snapshot.tiles) {
    const VoxelBox part = tile.intersection(voxels);
    if (part.volume() == 0) continue;
    for (int x = part.min.x & -8; x < part.max.x; x += 8) {
      for (int y = part.min.y & -8; y < part.max.y; y += 8) {
        for (int z = part.min.z & -8; z < part.max.z; z += 8) entry({x, y, z}) = kUnknown;
      }
    }
  }
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    if (VoxelBox::from_dims(leaf.origin, {8, 8, 8}).intersection(voxels).volume() == 0) continue;
    entry(leaf.origin) = static_cast<std::int32_t>(masks_.size());
    masks_.push_back({leaf.non_free, leaf.occupied});
  }
}

int BlockMasks::inside(Index3 lowest) const {
  const int edge = 1 << shift_;
  if (!is_cut_) return edge * edge * edge;
  return static_cast<int>(
      VoxelBox::from_dims(lowest, {edge, edge, edge}).intersection(workspace_).volume());
}

int BlockMasks::count(const LeafMask& mask, Index3 lowest) const {
  const auto x = static_cast<std::size_t>(lowest.x & 7);
  const auto corner = static_cast<unsigned>((lowest.y & 7) << 3 | (lowest.z & 7));
  if (shift_ == 0) return static_cast<int>(mask[x] >> corner & 1U);
  constexpr std::array<std::uint64_t, 4> kPlane{1, 0x303, 0x0F0F0F0F, ~std::uint64_t{0}};
  const std::uint64_t plane = kPlane[static_cast<std::size_t>(shift_)] << corner;
  int bits = 0;
  for (std::size_t i = x; i < x + (std::size_t{1} << shift_); ++i) {
    bits += std::popcount(mask[i] & plane);
  }
  return bits;
}

int BlockMasks::non_free(Index3 lowest, int inside) const {
  const std::int32_t at = blocks_[index(lowest)];
  if (at == kFree) return 0;
  return at == kUnknown ? inside : count(masks_[static_cast<std::size_t>(at)].non_free, lowest);
}

int BlockMasks::free_voxels(Index3 cell) const {
  const Index3 first = lowest(cell);
  const int part = inside(first);
  return (part - non_free(first, part)) * (1 << (3 * shift_)) / part;
}

BlockMasks::Cell BlockMasks::looked_up(Index3 cell) const {
  const Index3 first = lowest(cell);
  if (non_free(first, inside(first)) == 0) return Cell::free;
  const std::int32_t at = blocks_[index(first)];
  const bool is_occupied =
      at >= 0 && count(masks_[static_cast<std::size_t>(at)].occupied, first) > 0;
  return is_occupied ? Cell::occupied : Cell::other;
}

}  // namespace viewgain::detail
