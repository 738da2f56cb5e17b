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

/// What rays need that go on through unknown voxels: states and hazard, found by place.
struct BrickTable : BrickIndex {
  /// Kinds of entries, in the two highest bits. The rest: edge of the largest aligned free cube
  /// round the brick [voxels], 8 to 128; else the brick's slot.
  static constexpr std::uint32_t kFree = 0, kUnknown = 1, kMixed = 2;
  static constexpr std::uint32_t kPayload = 0x3FFFFFFFU;
  static constexpr std::uint32_t kFarSlot = 0;  ///< of all bricks with the far rate throughout

  /// Two bits a voxel; in `states` 16 for each cube of 2³ voxels (x << 2 | y << 1 | z), and above
  /// them the edge of the largest aligned cube round its voxels that is free or unknown throughout,
  /// 1, 2 or 4.
  static constexpr std::uint32_t kFreeVoxel = 0, kUnknownVoxel = 1, kOccupiedVoxel = 2;
  static constexpr std::uint32_t kAllUnknown = 0x5555;

  double pooling_length = 1;          ///< [voxels]: Pooling::length
  int rate_shift = 0;                 ///< rates are by cubes of 2^rate_shift voxels
  std::vector<std::uint32_t> states;  ///< 64 a mixed brick, by slot; slots begin with those
  /// 8^(3 - rate_shift) a slot [1/voxel]; with the sign bit set where surface is not new.
  std::vector<float> rates;

  /// Where the surface looks, for each cube of 2³ voxels of `states` that holds occupied ones: unit
  /// normals towards free voxels, 10 bits a number (pack_normal); 0: not known.
  std::vector<std::uint32_t> normals;

  BrickTable(const GridSnapshot& snapshot, const HazardField& hazard);

  /// The outward normal at an occupied voxel in table coordinates, grid frame; zero if not known.
  [[nodiscard]] Eigen::Vector3f normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const;

  /// Where `rates` has the hazard cell of an unknown voxel of the lattice; nothing where bricks
  /// share a slot.
  [[nodiscard]] std::optional<std::size_t> rate_place(Index3 voxel) const {
    const auto [x, y, z] = in_table(voxel);
    const std::uint32_t entry = entries[entry_index(x, y, z)];
    if (entry >> 30U == kFree || (entry & kPayload) == kFarSlot) return std::nullopt;
    const auto cell = [this](std::int32_t i) { return (i & (kBrick - 1)) >> rate_shift; };
    const int bits = 3 - rate_shift;
    return (std::size_t{entry & kPayload} << 3 * bits) +
           static_cast<std::size_t>(cell(x) << 2 * bits | cell(y) << bits | cell(z));
  }

  /// Which of the snapshot's leaves a voxel of the lattice is in; it must be in one.
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
