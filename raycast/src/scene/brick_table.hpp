// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/support/brick_index.hpp"

namespace viewgain::detail {

/// States and hazard of unknown space, looked up by place, for rays that go on through it.
///
/// Where rates are low, cells of the HazardField that are unknown throughout and have one rate are
/// joined: rays cross aligned cubes of up to 8³ voxels in one step.
struct BrickTable : BrickIndex {
  /// Kinds of entries, in the two highest bits. The rest: for a free brick, the edge of the largest
  /// aligned free cube around it [voxels], 8 to 128; else the place of its first record. Bricks
  /// that are unknown throughout and have the far rate share records, at place 0.
  static constexpr std::uint32_t kFree = 0, kUnknown = 1, kMixed = 2;
  static constexpr std::uint32_t kPayload = 0x3FFFFFFFU;

  static constexpr std::uint32_t kFreeVoxel = 0, kUnknownVoxel = 1, kOccupiedVoxel = 2;
  static constexpr std::uint32_t kAllUnknown = 0x5555;  ///< eight states of two bits

  double pooling_length = 1;  ///< [voxels]: Pooling::length
  int rate_shift = 0;         ///< HazardField::cell_shift()

  /// What is read for a step. The sign of a rate is set where surface is not new. An edge is that
  /// of the largest aligned cube around the voxel that is free throughout, or unknown and joined.
  /// - If rate_shift is 0, a word per voxel: its rate [1/voxel], of which the five lowest bits are
  ///   replaced by edge - 1 (kTopBits) and the state (kStateBits).
  /// - Otherwise two words per cube of 2³ voxels, in unknown bricks per cell of the hazard field:
  ///   eight states (voxel x << 2 | y << 1 | z) below the edge (kEdgeShift), then the rate.
  std::vector<std::uint32_t> records;
  static constexpr std::uint32_t kStateBits = 3, kTopBits = 28, kEdgeShift = 16;

  /// Where the surface looks, for each cube of 2³ voxels that holds occupied ones, by slot: unit
  /// normals towards free voxels, 10 bits a number (pack_normal); 0: not known.
  std::vector<std::uint32_t> normals;

  BrickTable(const GridSnapshot& snapshot, const HazardField& hazard);

  /// The outward normal at an occupied voxel in table coordinates, grid frame; zero if unknown.
  [[nodiscard]] Eigen::Vector3f normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const;

  /// Number of records.
  [[nodiscard]] std::size_t places() const { return records.size() >> (rate_shift > 0 ? 1U : 0U); }
  /// Place of the record of an unknown voxel of the lattice; nothing where bricks share records. In
  /// arrays beside the table, such as `missed` of WalkKernels::area(), the place of a hazard cell
  /// is that of its lowest voxel.
  [[nodiscard]] std::optional<std::size_t> place_of(Index3 voxel) const {
    const auto [x, y, z] = in_table(voxel);
    const std::uint32_t entry = entries[entry_index(x, y, z)];
    const std::uint32_t kind = entry >> 30U, first = entry & kPayload;
    if (kind == kFree || first == 0) return std::nullopt;
    const int cut = kind == kMixed ? std::min(rate_shift, 1) : rate_shift, bits = 3 - cut;
    const auto part = [cut](std::int32_t i) { return (i & (kBrick - 1)) >> cut; };
    return first + static_cast<std::size_t>(part(x) << 2 * bits | part(y) << bits | part(z));
  }

  /// Index of the snapshot's leaf that contains a voxel; there must be one.
  [[nodiscard]] std::size_t leaf_of(Index3 voxel) const {
    const auto [x, y, z] = in_table(voxel);
    return slot_of(entries[entry_index(x, y, z)]) - 1;
  }
  /// Number of a mixed brick, from 1.
  [[nodiscard]] std::size_t slot_of(std::uint32_t entry) const {
    return (entry & kPayload) >> (rate_shift > 0 ? 6U : 9U);
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return BrickIndex::bytes() + (records.size() + normals.size()) * sizeof(std::uint32_t);
  }
};

}  // namespace viewgain::detail
