// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "occlusion_steps.hpp"
#include "viewgain/grid/occupancy_codes.hpp"

namespace viewgain::detail {

/// What classic gains weigh of each voxel, found by place: nodes of 128³ voxels have 16³ entries,
/// one for each brick of 8³.
///
/// Table coordinates count voxels from the lowest voxel of the workspace's lowest brick, where the
/// first node begins too; the workspace's lowest voxel is `offset`, in 0..7 along each axis.
struct ClassicTable {
  /// A word: code of the log-odds; whether it is a surface frontier; steps behind a measured
  /// surface; edge of the largest aligned cube round it [voxels] whose words are the same, 1, 2 or
  /// 4 in a brick, 8 to kLargestEdge else.
  static constexpr std::uint32_t kCode = 0x7FU, kFrontier = 0x80U;
  static constexpr int kStepsShift = 8, kEdgeShift = 16;
  static constexpr std::uint32_t kMostSteps = 255, kValue = 0xFFFFU, kEdge = 0x3FU;
  static constexpr unsigned kLargestEdge = 32;
  /// An entry is the word of all its brick's voxels with this bit, or its first index in `words`.
  static constexpr std::uint32_t kUniform = 0x80000000U;

  Index3 base;                                   ///< lattice index of the voxel (0, 0, 0)
  std::array<std::int32_t, 3> offset{}, size{};  ///< of the workspace
  std::array<std::int32_t, 3> nodes{};           ///< along x, y, z
  std::vector<std::uint32_t> node_entries;       ///< first entry of each node, x-major
  std::vector<std::uint32_t> entries;            ///< 4096 a node, x-major
  std::vector<std::uint32_t> words;              ///< 512 a mixed brick, x << 6 | y << 3 | z

  explicit ClassicTable(const OccupancyCodes& codes);

  /// Puts the steps of unknown voxels in.
  void add(const OcclusionSteps& steps);

  /// Of a voxel of the workspace in table coordinates.
  [[nodiscard]] std::uint32_t word(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::uint32_t entry = entries[entry_index(x, y, z)];
    if ((entry & kUniform) != 0) return entry;
    return words[entry + static_cast<std::uint32_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7))];
  }
  /// The voxel's node.
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

  [[nodiscard]] std::uint64_t bytes() const {
    return (node_entries.size() + entries.size() + words.size()) * sizeof(std::uint32_t);
  }
};

}  // namespace viewgain::detail
