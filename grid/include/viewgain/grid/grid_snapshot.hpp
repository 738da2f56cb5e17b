// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/grid/hazard_counters.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain {

struct BeliefBlock;

/// The data that a VoxelScene takes from a BeliefGrid: an immutable value, safe to share between
/// threads. A leaf is a block of 8³ voxels. A tile is a larger box of unknown voxels. Free leaves
/// are not stored. Members do not check their arguments.
struct VIEWGAIN_EXPORT GridSnapshot {
  /// A leaf with at least one voxel that is not free. Voxels outside the workspace count as free.
  struct Leaf {
    Index3 origin;        ///< lowest voxel, a multiple of 8
    LeafMask non_free{};  ///< voxels that are unknown or occupied
    LeafMask occupied{};  ///< voxels that are occupied
    /// Its beliefs, which can include those of free voxels. Can be null.
    std::shared_ptr<const BeliefBlock> beliefs;
  };
  /// A cube of 32³ voxels of the lattice. Its leaves are consecutive in `leaves`, and its tiles in
  /// `tiles`.
  struct Region {
    std::uint64_t number = 0;   ///< identifies the region; the same in all snapshots of a grid
    std::uint64_t changed = 0;  ///< GridSnapshot::time of the last change of its voxels
    /// Index of its first leaf. Its leaves are sorted by x, then y, then z of their origin.
    std::uint32_t first_leaf = 0;
    std::uint32_t first_tile = 0;  ///< index of its first tile
  };

  double voxel_size = 0;     ///< [m]
  double prior_sigma = 0;    ///< [m]
  Pose T_world_grid;         ///< pose of the grid frame in the world
  Index3 min_index;          ///< lowest voxel of the workspace
  Index3 dims;               ///< voxels along x, y, z
  HazardCounters hazard;     ///< counts that correct the hazard
  std::vector<Leaf> leaves;  ///< those that are not free, in the order of `regions`
  /// Tiles of unknown voxels, clipped to the workspace. Tiles larger than a region come first:
  /// those of 2048³ voxels, then those of 128³, each sorted by x, y, z. The other tiles follow in
  /// the order of `regions`.
  std::vector<VoxelBox> tiles;
  std::vector<Region> regions;  ///< regions that have leaves or tiles, by increasing number
  /// Identifies the grid, for BeliefGrid::snapshot(before). 0: no grid.
  std::uint64_t grid_number = 0;
  std::uint64_t time = 0;  ///< counter of the grid's changes, at the last change
  /// `time` of the earlier snapshot from which this one was made; 0 if there was none.
  std::uint64_t shared_until = 0;

  /// Whether this snapshot was made from an earlier one, and the region did not change since.
  [[nodiscard]] bool is_shared(const Region& region) const {
    return shared_until != 0 && region.changed <= shared_until;
  }

  /// The voxel that contains a point in the world frame [m]. Empty if the point lies outside the
  /// workspace or is not finite.
  [[nodiscard]] std::optional<Index3> index_of(const Eigen::Vector3d& p_world) const;
  /// Centre of a voxel in the world frame [m].
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;

  /// The leaf that contains a voxel; null if `leaves` does not contain it. O(log regions).
  [[nodiscard]] const Leaf* find_leaf(Index3 voxel) const;

  /// Whether a voxel is free; true outside the workspace. O(log regions + log tiles).
  [[nodiscard]] bool is_free(Index3 voxel) const;

  /// Indices of a region's first leaf, and one past its last. `region` is the index in `regions`.
  [[nodiscard]] std::array<std::uint32_t, 2> leaves_of(std::size_t region) const {
    return {regions[region].first_leaf, region + 1 < regions.size()
                                            ? regions[region + 1].first_leaf
                                            : static_cast<std::uint32_t>(leaves.size())};
  }
  /// Indices of a region's first tile, and one past its last. `region` is the index in `regions`.
  [[nodiscard]] std::array<std::uint32_t, 2> tiles_of(std::size_t region) const {
    return {regions[region].first_tile, region + 1 < regions.size()
                                            ? regions[region + 1].first_tile
                                            : static_cast<std::uint32_t>(tiles.size())};
  }
};

}  // namespace viewgain
