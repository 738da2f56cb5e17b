// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain::detail {

/// What rays need that go on through unknown voxels: states and hazard, found by place. Nodes of
/// 128³ voxels have 16³ entries, one for each brick of 8³ voxels; a node that is free throughout,
/// or unknown with the far rate, has no entries of its own.
///
/// Table coordinates count voxels from the lowest voxel of the workspace's lowest brick, where the
/// first node begins too; the workspace's lowest voxel is `offset`, in 0..7 along each axis.
struct BrickTable {
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

  std::array<std::int32_t, 3> offset{};
  std::array<std::int32_t, 3> nodes{};      ///< along x, y, z
  double pooling_length = 1;                ///< [voxels]: Pooling::length
  int rate_shift = 0;                       ///< rates are by cubes of 2^rate_shift voxels
  std::vector<std::uint32_t> node_entries;  ///< first entry of each node, x-major
  std::vector<std::uint32_t> entries;       ///< 4096 a node, x-major
  std::vector<std::uint32_t> states;        ///< 64 a mixed brick, by slot; slots begin with those
  /// 8^(3 - rate_shift) a slot [1/voxel]; with the sign bit set where surface is not new.
  std::vector<float> rates;

  /// Where the surface looks, for each cube of 2³ voxels of `states` that holds occupied ones: unit
  /// normals towards free voxels, 10 bits a number (pack_normal); 0: not known.
  std::vector<std::uint32_t> normals;

  BrickTable(const GridSnapshot& snapshot, const HazardField& hazard);

  /// The outward normal at an occupied voxel in table coordinates, grid frame; zero if not known.
  [[nodiscard]] Eigen::Vector3f normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const;

  [[nodiscard]] std::uint64_t bytes() const {
    return (node_entries.size() + entries.size() + states.size() + normals.size()) *
               sizeof(std::uint32_t) +
           rates.size() * sizeof(float);
  }

 private:
  /// Index into `entries` of the brick of a voxel in table coordinates.
  [[nodiscard]] std::size_t entry_index(std::int32_t x, std::int32_t y, std::int32_t z) const;
  friend class BrickTableMaker;
};

}  // namespace viewgain::detail
