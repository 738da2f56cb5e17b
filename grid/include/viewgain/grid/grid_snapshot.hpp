// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "viewgain/core/covariance.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Voxel state; the numbers are those of dense arrays in every language.
enum class VoxelState : std::uint8_t { unknown = 0, free = 1, occupied = 2 };

/// Index of a voxel on the grid's lattice (through the origin of the grid's frame).
struct VIEWGAIN_EXPORT Index3 {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const Index3&) const = default;
};

/// What readings have said about one voxel, in single precision as in the map files, grid frame.
struct VIEWGAIN_EXPORT Belief {
  std::array<float, 6> information{};         ///< Λ_v: xx yy zz xy xz yz [m⁻²]
  std::array<float, 3> information_vector{};  ///< η_v = Σ Λ_r (p_r - voxel centre) [m⁻¹]
  std::uint32_t hits = 0;                     ///< readings that ended here

  [[nodiscard]] SymmetricMatrix3 information_matrix() const {
    return {information[0], information[1], information[2],
            information[3], information[4], information[5]};
  }
  bool operator==(const Belief&) const = default;
};

/// One bit a voxel of an 8³ leaf: word x, bit y << 3 | z (OpenVDB's order).
using LeafMask = std::array<std::uint64_t, 8>;

[[nodiscard]] inline bool test_bit(const LeafMask& mask, unsigned offset) {
  return ((mask[offset >> 6U] >> (offset & 63U)) & 1U) != 0;
}

/// The beliefs of one leaf: those of the voxels in `mask`, in order of their offsets.
struct VIEWGAIN_EXPORT BeliefBlock {
  LeafMask mask{};
  std::vector<Belief> beliefs;

  /// Position in `beliefs` of the voxel with this offset (x << 6 | y << 3 | z); the bit must be
  /// set.
  [[nodiscard]] std::size_t rank(unsigned offset) const {
    int below = 0;
    for (unsigned word = 0; word < offset >> 6U; ++word) below += std::popcount(mask[word]);
    const std::uint64_t low = (std::uint64_t{1} << (offset & 63U)) - 1U;
    return static_cast<std::size_t>(below + std::popcount(mask[offset >> 6U] & low));
  }
  [[nodiscard]] const Belief* find(unsigned offset) const {
    return test_bit(mask, offset) ? &beliefs[rank(offset)] : nullptr;
  }
};

/// A block of beliefs and its lowest voxel, a multiple of 8.
struct VIEWGAIN_EXPORT BeliefBlockAt {
  Index3 origin;
  std::shared_ptr<const BeliefBlock> beliefs;
};

/// A leaf with at least one voxel that is not free, clipped to the workspace.
struct VIEWGAIN_EXPORT SnapshotLeaf {
  Index3 origin;        ///< lowest voxel, a multiple of 8
  LeafMask non_free{};  ///< unknown or occupied
  LeafMask occupied{};
  std::shared_ptr<const BeliefBlock> beliefs;  ///< null without occupied voxels; else may be null,
                                               ///< may hold free voxels' beliefs too
};

/// A box of voxels, all unknown, clipped to the workspace: [min, max).
struct VIEWGAIN_EXPORT SnapshotTile {
  Index3 min;
  Index3 max;
};

/// A cube of 32³ voxels of the lattice; its leaves and tiles follow one another in the lists.
struct VIEWGAIN_EXPORT SnapshotRegion {
  std::uint64_t number = 0;   ///< lists of regions rise in it; the same in all snapshots of a grid
  std::uint64_t changed = 0;  ///< when its voxels changed last
  std::uint32_t first_leaf = 0;
  std::uint32_t first_tile = 0;
};

/// Everything a scene reads of a grid: an immutable value, safe to share between threads.
struct VIEWGAIN_EXPORT GridSnapshot {
  double voxel_size = 0;   ///< [m]
  double prior_sigma = 0;  ///< [m]
  Pose T_world_grid;
  Index3 min_index;  ///< lowest voxel of the workspace
  Index3 dims;       ///< voxels along x, y, z
  std::vector<SnapshotLeaf> leaves;
  std::vector<SnapshotTile> tiles;  ///< those larger than a region first
  std::vector<SnapshotRegion> regions;
  /// Which grid it is of and when, for BeliefGrid::snapshot(before); 0: none.
  std::uint64_t grid_number = 0;
  std::uint64_t time = 0;
  /// For a snapshot made from an earlier one: when that was; else 0.
  std::uint64_t shared_until = 0;

  /// Is the region as it was in that earlier snapshot, provided that it is listed there?
  [[nodiscard]] bool is_shared(const SnapshotRegion& region) const {
    return shared_until != 0 && region.changed <= shared_until;
  }

  /// The leaf that holds a voxel, null if there is none. O(log regions).
  [[nodiscard]] const SnapshotLeaf* find_leaf(Index3 voxel) const;

  /// The [first, last) leaves and tiles of a region, by its place in the list.
  [[nodiscard]] std::array<std::uint32_t, 2> leaves_of(std::size_t region) const {
    return {regions[region].first_leaf, region + 1 < regions.size()
                                            ? regions[region + 1].first_leaf
                                            : static_cast<std::uint32_t>(leaves.size())};
  }
  [[nodiscard]] std::array<std::uint32_t, 2> tiles_of(std::size_t region) const {
    return {regions[region].first_tile, region + 1 < regions.size()
                                            ? regions[region + 1].first_tile
                                            : static_cast<std::uint32_t>(tiles.size())};
  }
};

}  // namespace viewgain
