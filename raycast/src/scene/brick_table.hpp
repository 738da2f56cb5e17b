// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/support/brick_index.hpp"

namespace viewgain::detail {

/// States and hazard by position, for rays that continue through unknown voxels.
struct BrickTable : BrickIndex {
  /// Kinds of entries, in the two highest bits. For free bricks the rest is the edge of the largest
  /// aligned free cube around the brick [voxels], 8 to 128; otherwise the brick's slot.
  static constexpr std::uint32_t kFree = 0, kUnknown = 1, kMixed = 2;
  static constexpr std::uint32_t kPayload = 0x3FFFFFFFU;
  /// Shared by all bricks that have the far rate everywhere.
  static constexpr std::uint32_t kFarSlot = 0;

  /// States of two bits. A word of `states` has 16 bits for a cube of 2³ voxels (x << 2 | y << 1 |
  /// z). Above them is the edge, 1, 2 or 4, of the largest aligned cube around its voxels that is
  /// entirely free or entirely unknown.
  static constexpr std::uint32_t kFreeVoxel = 0, kUnknownVoxel = 1, kOccupiedVoxel = 2;
  static constexpr std::uint32_t kAllUnknown = 0x5555;

  double pooling_length = 1;  ///< [voxels]: Pooling::length
  int rate_shift = 0;         ///< rates are per cube of 2^rate_shift voxels per edge
  /// 64 per mixed brick, by slot; mixed bricks have the first slots.
  std::vector<std::uint32_t> states;
  /// 8^(3 - rate_shift) per slot [1/voxel]; the sign bit is set if surface there is not new.
  std::vector<float> rates;

  /// For each cube of 2³ voxels in `states` that contains occupied voxels: unit normal towards free
  /// voxels, 10 bits per number (pack_normal); 0: unknown.
  std::vector<std::uint32_t> normals;

  BrickTable(const GridSnapshot& snapshot, const HazardField& hazard);

  /// The outward normal at an occupied voxel in table coordinates, grid frame; zero if unknown.
  [[nodiscard]] Eigen::Vector3f normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const;

  /// Index in `rates` of the hazard cell of an unknown voxel; empty if bricks share a slot.
  [[nodiscard]] std::optional<std::size_t> rate_place(Index3 voxel) const {
    const auto [x, y, z] = in_table(voxel);
    const std::uint32_t entry = entries[entry_index(x, y, z)];
    if (entry >> 30U == kFree || (entry & kPayload) == kFarSlot) return std::nullopt;
    const auto cell = [this](std::int32_t i) { return (i & (kBrick - 1)) >> rate_shift; };
    const int bits = 3 - rate_shift;
    return (std::size_t{entry & kPayload} << 3 * bits) +
           static_cast<std::size_t>(cell(x) << 2 * bits | cell(y) << bits | cell(z));
  }

  /// Index of the snapshot's leaf that contains a voxel; there must be one.
  [[nodiscard]] std::size_t leaf_of(Index3 voxel) const {
    const auto [x, y, z] = in_table(voxel);
    return (entries[entry_index(x, y, z)] & kPayload) - 1;  // slots begin with kFarSlot
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return BrickIndex::bytes() + (states.size() + normals.size()) * sizeof(std::uint32_t) +
           rates.size() * sizeof(float);
  }
};

}  // namespace viewgain::detail
