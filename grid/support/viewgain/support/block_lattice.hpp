// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

inline constexpr int kBlockSize = 8;    ///< an OpenVDB leaf
inline constexpr int kRegionSize = 32;  ///< unit of work of a thread
inline constexpr int kNodeSize = 128;   ///< an OpenVDB node of leaves

/// The voxels of the block at `origin` that lie in the box.
[[nodiscard]] inline LeafMask block_mask(const VoxelBox& box, Index3 origin) {
  const auto range = [](std::int32_t low, std::int32_t from, std::int32_t to) {
    return std::array{std::clamp(from - low, 0, kBlockSize), std::clamp(to - low, 0, kBlockSize)};
  };
  const auto x = range(origin.x, box.min.x, box.max.x), y = range(origin.y, box.min.y, box.max.y),
             z = range(origin.z, box.min.z, box.max.z);
  std::uint64_t plane = 0;
  for (int j = y[0]; j < y[1]; ++j) {
    for (int k = z[0]; k < z[1]; ++k) plane |= std::uint64_t{1} << (8 * j + k);
  }
  LeafMask mask{};
  for (int i = x[0]; i < x[1]; ++i) mask[static_cast<std::size_t>(i)] = plane;
  return mask;
}

/// The lattices of 8³ blocks, 32³ regions and 128³ nodes over a workspace, with keys. A key
/// identifies a block: node, then region in the node, then block in the region, so blocks sorted by
/// key are grouped by region and by node.
///
/// The box is the workspace.
struct BlockLattice : VoxelBox {
  Index3 node_min;                       ///< origin of the lowest node
  std::array<std::uint32_t, 3> nodes{};  ///< nodes along x, y, z

  BlockLattice(Index3 min_index, Index3 dims)
      : VoxelBox(from_dims(min_index, dims)),
        node_min{min.x & ~(kNodeSize - 1), min.y & ~(kNodeSize - 1), min.z & ~(kNodeSize - 1)} {
    const auto count = [](std::int32_t from, std::int32_t to) {
      return static_cast<std::uint32_t>((to - from + kNodeSize - 1) / kNodeSize);
    };
    nodes = {count(node_min.x, max.x), count(node_min.y, max.y), count(node_min.z, max.z)};
  }

  /// Whether the cube [origin, origin + size) shares a voxel with the workspace.
  [[nodiscard]] bool overlaps(Index3 origin, int size) const {
    return origin.x < max.x && origin.x + size > min.x && origin.y < max.y &&
           origin.y + size > min.y && origin.z < max.z && origin.z + size > min.z;
  }
  [[nodiscard]] bool covers(Index3 origin, int size) const {
    return origin.x >= min.x && origin.x + size <= max.x && origin.y >= min.y &&
           origin.y + size <= max.y && origin.z >= min.z && origin.z + size <= max.z;
  }

  [[nodiscard]] std::uint64_t node_count() const {
    return std::uint64_t{nodes[0]} * nodes[1] * nodes[2];
  }

  /// Key of the block that contains the voxel, which must lie in the nodes' range.
  [[nodiscard]] std::uint64_t key(Index3 v) const {
    const auto x = static_cast<std::uint32_t>(v.x - node_min.x);
    const auto y = static_cast<std::uint32_t>(v.y - node_min.y);
    const auto z = static_cast<std::uint32_t>(v.z - node_min.z);
    const std::uint64_t node =
        (std::uint64_t{x >> 7U} * nodes[1] + (y >> 7U)) * nodes[2] + (z >> 7U);
    const auto two_bits = [&](unsigned shift) {
      return std::uint64_t{((x >> shift & 3U) << 4U) | ((y >> shift & 3U) << 2U) |
                           (z >> shift & 3U)};
    };
    return node << 12U | two_bits(5) << 6U | two_bits(3);
  }

  /// Lowest voxel of the block with this key.
  [[nodiscard]] Index3 origin(std::uint64_t key) const {
    const std::uint64_t node = key >> 12U;
    const auto low = static_cast<std::uint32_t>(key & 4095U);
    const auto part = [low](unsigned axis) {
      return static_cast<std::int32_t>((low >> (10U - 2U * axis) & 3U) * kRegionSize +
                                       (low >> (4U - 2U * axis) & 3U) * kBlockSize);
    };
    return {
        node_min.x + static_cast<std::int32_t>(node / nodes[2] / nodes[1]) * kNodeSize + part(0),
        node_min.y + static_cast<std::int32_t>(node / nodes[2] % nodes[1]) * kNodeSize + part(1),
        node_min.z + static_cast<std::int32_t>(node % nodes[2]) * kNodeSize + part(2)};
  }

  /// The voxels of a block that belong to the workspace.
  [[nodiscard]] LeafMask clip(Index3 origin) const { return block_mask(*this, origin); }
};

/// The part of a cube that belongs to the workspace.
[[nodiscard]] inline VoxelBox clipped(const BlockLattice& lattice, Index3 origin, int size) {
  return lattice.intersection(VoxelBox::from_dims(origin, {size, size, size}));
}

[[nodiscard]] inline Index3 block_origin(Index3 v) { return {v.x & ~7, v.y & ~7, v.z & ~7}; }

[[nodiscard]] inline std::uint64_t count_bits(const LeafMask& mask) {
  int n = 0;
  for (const std::uint64_t word : mask) n += std::popcount(word);
  return static_cast<std::uint64_t>(n);
}

[[nodiscard]] inline LeafMask intersection(const LeafMask& a, const LeafMask& b) {
  LeafMask result;
  for (std::size_t i = 0; i < 8; ++i) result[i] = a[i] & b[i];
  return result;
}

}  // namespace viewgain::detail

namespace viewgain {

// Voxels of a grid by blocks, for importers and exporters that do not include OpenVDB. Codes are
// those of log_odds_code.hpp; voxels outside the workspace are undefined.

/// Writes the 512 codes of the block at `origin`, which must overlap the workspace. Beliefs and
/// scales remain. Marks the block as changed for snapshots and scenes, as fill_cube() does.
VIEWGAIN_EXPORT void put_block(BeliefGrid& grid, Index3 origin, const std::uint8_t* codes);

/// Sets all voxels of a cube to one code; `size` is a power of two, at least 8, and `origin` a
/// multiple of it. Cost: a tile where possible: for free and unknown, not for occupied.
VIEWGAIN_EXPORT void fill_cube(BeliefGrid& grid, Index3 origin, std::int32_t size,
                               std::uint8_t code);

/// Calls block(origin, codes), with codes valid until the grid changes, and cube(origin, size,
/// code) for all parts that overlap the workspace, in any order. Cubes are aligned to their size, a
/// power of two from 8 to 2048.
VIEWGAIN_EXPORT void visit_grid(
    const BeliefGrid& grid, const std::function<void(Index3, const std::uint8_t*)>& block,
    const std::function<void(Index3, std::int32_t, std::uint8_t)>& cube);

namespace detail {

// For this module only.

/// Beliefs of the block that contains a voxel of the workspace; null if there are none.
[[nodiscard]] const BeliefBlock* find_beliefs(const BeliefGrid& grid, Index3 voxel);

/// Memory of the grid.
[[nodiscard]] std::uint64_t bytes_of(const BeliefGrid& grid);

}  // namespace detail

}  // namespace viewgain
