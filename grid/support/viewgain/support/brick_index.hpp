// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// The bricks of a workspace, of 8³ voxels, indexed by place: nodes of 128³ voxels have 16³
/// entries, one per brick. The table that uses it defines the entries. Uniform nodes share entries.
///
/// Table coordinates count voxels from the lowest voxel of the workspace's lowest brick, where the
/// first node starts too; the workspace's lowest voxel is `offset`, in 0..7 along each axis.
struct BrickIndex {
  static constexpr std::int32_t kBrick = 8, kNode = 128;   ///< edges [voxels]
  static constexpr std::uint32_t kEntries = 16 * 16 * 16;  ///< of a node
  static constexpr std::size_t kMostNodes = std::size_t{1} << 24U;

  Index3 base;                                   ///< lattice index of the voxel (0, 0, 0)
  std::array<std::int32_t, 3> offset{}, size{};  ///< of the workspace
  std::array<std::int32_t, 3> nodes{};           ///< along x, y, z
  std::vector<std::uint32_t> node_entries;       ///< first entry of each node, x-major
  std::vector<std::uint32_t> entries;            ///< kEntries per node, x-major

  /// All nodes share entries of `fill`. Throws Error(capacity) above 2^24 nodes.
  BrickIndex(Index3 min_index, Index3 dims, std::uint32_t fill)
      : base{min_index.x & -kBrick, min_index.y & -kBrick, min_index.z & -kBrick},
        offset{min_index.x - base.x, min_index.y - base.y, min_index.z - base.z},
        size{dims.x, dims.y, dims.z} {
    std::size_t count = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t end = std::int64_t{offset[a]} + size[a];
      nodes[a] = static_cast<std::int32_t>((end + kNode - 1) / kNode);
      count *= static_cast<std::size_t>(nodes[a]);
      if (count > kMostNodes) {
        throw Error(ErrorCode::capacity,
                    "the workspace has more than " + std::to_string(kMostNodes) +
                        " cubes with edges of 128 voxels, the maximum for this gain");
      }
    }
    node_entries.assign(count, shared_node(fill));
  }

  /// Throws Error(capacity) if gathers, which have signed 32-bit indices, cannot reach all.
  static void check_capacity(std::size_t count) {
    if (count > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
      throw Error(ErrorCode::capacity, "the map is too large for this gain; use larger voxels");
    }
  }

  /// Entry of a voxel in table coordinates.
  [[nodiscard]] std::size_t node_index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (static_cast<std::size_t>(x >> 7) * static_cast<std::size_t>(nodes[1]) +
            static_cast<std::size_t>(y >> 7)) *
               static_cast<std::size_t>(nodes[2]) +
           static_cast<std::size_t>(z >> 7);
  }
  [[nodiscard]] std::size_t entry_index(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return node_entries[node_index(x, y, z)] +
           static_cast<std::size_t>((x >> 3 & 15) << 8 | (y >> 3 & 15) << 4 | (z >> 3 & 15));
  }
  /// The table coordinates of a voxel of the lattice.
  [[nodiscard]] Index3 in_table(Index3 voxel) const {
    return {voxel.x - base.x, voxel.y - base.y, voxel.z - base.z};
  }
  /// The workspace, in table coordinates.
  [[nodiscard]] VoxelBox workspace() const {
    return VoxelBox::from_dims({offset[0], offset[1], offset[2]}, {size[0], size[1], size[2]});
  }

  /// First of the entries that are all `fill`, shared by any number of nodes.
  std::uint32_t shared_node(std::uint32_t fill) {
    const auto found = std::find_if(shared_.begin(), shared_.end(),
                                    [&](const Shared& node) { return node.fill == fill; });
    if (found != shared_.end()) return found->first;
    shared_.push_back({fill, add_node(fill)});
    return shared_.back().first;
  }
  /// Entry of the brick of a voxel in table coordinates, in a node with its own entries.
  std::uint32_t& own_entry(std::int32_t x, std::int32_t y, std::int32_t z) {
    std::uint32_t& node = node_entries[node_index(x, y, z)];
    const auto found = std::find_if(shared_.begin(), shared_.end(),
                                    [&](const Shared& shared) { return shared.first == node; });
    if (found != shared_.end()) node = add_node(found->fill);
    return entries[entry_index(x, y, z)];
  }
  /// Sets all bricks of a box of table coordinates, within which a workspace's part counts as
  /// whole, to `entry(x, y, z)` of the brick that starts there. A whole node with `fill(x, y, z)`
  /// shares entries.
  template <typename Fill, typename Entry>
  void put(const VoxelBox& box, Fill&& fill, Entry&& entry) {
    const VoxelBox part = box.intersection(workspace());
    for_each_cube(part, kNode, [&](Index3 node, const VoxelBox& whole) {
      const VoxelBox within = whole.intersection(workspace());
      std::uint32_t& first = node_entries[node_index(node.x, node.y, node.z)];
      const std::optional<std::uint32_t> same =
          part.intersection(within) == within && is_shared(first) ? fill(node) : std::nullopt;
      if (same) {
        const std::uint32_t shared = shared_node(*same);
        node_entries[node_index(node.x, node.y, node.z)] = shared;
        return;
      }
      for_each_cube(part.intersection(whole), kBrick, [&](Index3 brick, const VoxelBox&) {
        const std::uint32_t value = entry(brick);
        own_entry(brick.x, brick.y, brick.z) = value;
      });
    });
  }
  /// Calls visit(first entry) for each node with its own entries.
  template <typename Visit>
  void for_each_own_node(Visit&& visit) {
    for (std::uint32_t first = 0; first < entries.size(); first += kEntries) {
      if (!is_shared(first)) visit(&entries[first]);
    }
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return (node_entries.size() + entries.size()) * sizeof(std::uint32_t);
  }

 private:
  struct Shared {
    std::uint32_t fill, first;
  };

  [[nodiscard]] bool is_shared(std::uint32_t first) const {
    return std::any_of(shared_.begin(), shared_.end(),
                       [&](const Shared& node) { return node.first == first; });
  }
  std::uint32_t add_node(std::uint32_t fill) {
    const std::size_t first = entries.size();
    check_capacity(first + kEntries);
    entries.resize(first + kEntries, fill);
    return static_cast<std::uint32_t>(first);
  }
  // The aligned cubes that overlap a box, x-major.
  template <typename Visit>
  static void for_each_cube(const VoxelBox& box, std::int32_t edge, Visit&& visit) {
    for (std::int32_t x = box.min.x & -edge; x < box.max.x; x += edge) {
      for (std::int32_t y = box.min.y & -edge; y < box.max.y; y += edge) {
        for (std::int32_t z = box.min.z & -edge; z < box.max.z; z += edge) {
          visit(Index3{x, y, z}, VoxelBox::from_dims({x, y, z}, {edge, edge, edge}));
        }
      }
    }
  }

  std::vector<Shared> shared_;
};

/// Sets for each of cells³ cells the size of the aligned uniform cube around it: at(x, y, z) is a
/// cell, widened(cell, edge) its value in a cube of `edge` cells if it had half of that, or empty
/// if it cannot grow.
template <typename At, typename Widened>
void widen_cubes(unsigned cells, unsigned largest, const At& at, const Widened& widened) {
  for (unsigned edge = 2; edge <= largest; edge *= 2) {
    const unsigned half = edge / 2;
    for (unsigned x = 0; x < cells; x += edge) {
      for (unsigned y = 0; y < cells; y += edge) {
        for (unsigned z = 0; z < cells; z += edge) {
          const auto cell = at(x, y, z);
          const auto wide = widened(cell, edge);
          bool same = wide.has_value();
          for (unsigned k = 1; k < 8 && same; ++k) {
            same = at(x + (k >> 2U) * half, y + (k >> 1U & 1U) * half, z + (k & 1U) * half) == cell;
          }
          if (!same) continue;
          for (unsigned i = 0; i < edge * edge * edge; ++i) {
            at(x + i / (edge * edge), y + i / edge % edge, z + i % edge) = *wide;
          }
        }
      }
    }
  }
}

}  // namespace viewgain::detail
