// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain {

/// The log-odds of every voxel of a map, free ones too, found by place: an immutable extract for
/// gains that weigh free space, which a GridSnapshot does not hold. Nodes of 128³ voxels have 16³
/// entries, one for each brick of 8³ voxels; what is the same throughout is kept once. Independent
/// of the grid once made; const members may run from many threads. Members take any voxel and any
/// code, and never throw.
struct VIEWGAIN_EXPORT OccupancyCodes {
  static constexpr std::uint8_t kUnknown = 0;  ///< of a voxel never observed
  static constexpr int kCount = 112;           ///< codes are below this
  static constexpr int kBrick = 8;             ///< voxels along a brick's edge
  static constexpr int kNode = 16;             ///< bricks along a node's edge
  /// In an entry: the low byte is the code of all voxels; else the rest is a brick's or a node's
  /// first index.
  static constexpr std::uint32_t kUniform = 0x80000000U;

  Index3 min_index;                     ///< lowest voxel of the workspace
  Index3 dims;                          ///< voxels along x, y, z
  Index3 first_brick;                   ///< number of its lowest brick: min_index / 8, rounded down
  std::array<std::int32_t, 3> nodes{};  ///< along x, y, z
  std::vector<std::uint32_t> node_entries;  ///< x-major: uniform, or first of 4096 in `entries`
  std::vector<std::uint32_t> entries;       ///< x-major in a node: uniform, or first of 512 codes
  std::vector<std::uint8_t> codes;  ///< of the bricks, in the order x << 6 | y << 3 | z in each

  /// Of the grid as it is. One pass over it; 512 bytes for each brick that is not uniform. Throws
  /// Error(capacity) beyond 2^31 codes or 2^24 nodes.
  explicit OccupancyCodes(const BeliefGrid& grid);

  /// Of a voxel of the workspace; kUnknown outside.
  [[nodiscard]] std::uint8_t code(Index3 voxel) const;

  /// What a code other than kUnknown stands for.
  [[nodiscard]] static float log_odds(std::uint8_t code);
  /// Is it that of an occupied voxel: log-odds above 0?
  [[nodiscard]] static bool is_occupied(std::uint8_t code);

  /// Memory that it takes [bytes].
  [[nodiscard]] std::uint64_t bytes() const {
    return (node_entries.size() + entries.size()) * sizeof(std::uint32_t) + codes.size();
  }
};

}  // namespace viewgain
