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
  /// A word of 13 bits. A known voxel's begins with the code of its log-odds, an unknown one's has
  /// kUnknown, its steps behind a measured surface and whether it is a surface frontier. Above
  /// either the binary logarithm of the edge of the largest aligned cube round it whose values are
  /// the same, 0 to 2 in a brick, 3 to kLargestShift else [voxels].
  static constexpr std::uint32_t kCode = 0x7FU, kFrontier = 1, kUnknown = 0x200U;
  static constexpr int kStepsShift = 1, kEdgeShift = 10;
  static constexpr std::uint32_t kMostSteps = 255, kValue = 0x3FFU, kEdge = 7;
  static constexpr unsigned kLargestShift = 5;
  [[nodiscard]] static bool is_unknown(std::uint32_t word) { return (word & kUnknown) != 0; }
  [[nodiscard]] static bool is_occupied(std::uint32_t word) {
    return !is_unknown(word) &&
           OccupancyCodes::is_occupied(static_cast<std::uint8_t>(word & kCode));
  }
  [[nodiscard]] static bool is_frontier(std::uint32_t word) {
    return is_unknown(word) && (word & kFrontier) != 0;
  }
  [[nodiscard]] static std::uint32_t steps(std::uint32_t word) {
    return is_unknown(word) ? word >> kStepsShift & kMostSteps : 0;
  }
  /// Edge of the cube [voxels].
  [[nodiscard]] static std::int32_t edge(std::uint32_t word) {
    return 1 << (word >> kEdgeShift & kEdge);
  }

  /// An entry is the word of all its brick's voxels with this bit, or its first index in `words`.
  static constexpr std::uint32_t kUniform = 0x80000000U;

  Index3 base;                                   ///< lattice index of the voxel (0, 0, 0)
  std::array<std::int32_t, 3> offset{}, size{};  ///< of the workspace
  std::array<std::int32_t, 3> nodes{};           ///< along x, y, z
  std::vector<std::uint32_t> node_entries;       ///< first entry of each node, x-major
  std::vector<std::uint32_t> entries;            ///< 4096 a node, x-major
  /// 512 a mixed brick, by word_in_brick(); those before the first brick are for gathers that read
  /// four bytes, which end in a word.
  std::vector<std::uint16_t> words;

  explicit ClassicTable(const OccupancyCodes& codes);

  /// Puts the steps of unknown voxels in.
  void add(const OcclusionSteps& steps);

  /// Of a voxel of the workspace in table coordinates.
  [[nodiscard]] std::uint32_t word(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::uint32_t entry = entries[entry_index(x, y, z)];
    if ((entry & kUniform) != 0) return entry;
    return words[entry + word_in_brick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                       static_cast<std::uint32_t>(z))];
  }
  /// Words lie by cubes of 4³, in two cache lines each.
  [[nodiscard]] static std::uint32_t word_in_brick(std::uint32_t x, std::uint32_t y,
                                                   std::uint32_t z) {
    return (x & 4U) << 6U | (y & 4U) << 5U | (z & 4U) << 4U | (x & 3U) << 4U | (y & 3U) << 2U |
           (z & 3U);
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
    return (node_entries.size() + entries.size()) * sizeof(std::uint32_t) +
           words.size() * sizeof(std::uint16_t);
  }
};

}  // namespace viewgain::detail
