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

/// The data that a scene reads from a grid: an immutable value, safe to share between threads.
/// Members check nothing: a region index must be valid.
struct VIEWGAIN_EXPORT GridSnapshot {
  /// A leaf with at least one voxel that is not free, clipped to the workspace.
  struct Leaf {
    Index3 origin;                               ///< lowest voxel, a multiple of 8
    LeafMask non_free{};                         ///< voxels that are unknown or occupied
    LeafMask occupied{};                         ///< voxels that are occupied
    std::shared_ptr<const BeliefBlock> beliefs;  ///< null without occupied voxels; otherwise may be
                                                 ///< null, and may contain beliefs of free voxels
  };
  /// A cube of 32³ lattice voxels; its leaves and tiles are contiguous in the lists.
  struct Region {
    std::uint64_t number = 0;   ///< the same in all snapshots of a grid; regions are sorted by it
    std::uint64_t changed = 0;  ///< time of the last change to its voxels
    /// A region's leaves are sorted by x, then y, then z of their origin.
    std::uint32_t first_leaf = 0;
    std::uint32_t first_tile = 0;  ///< first tile of this region in the list of tiles
  };

  double voxel_size = 0;     ///< [m]
  double prior_sigma = 0;    ///< [m]
  Pose T_world_grid;         ///< pose of the grid frame in the world
  Index3 min_index;          ///< lowest voxel of the workspace
  Index3 dims;               ///< voxels along x, y, z
  HazardCounters hazard;     ///< counters of frames for unknown space
  std::vector<Leaf> leaves;  ///< leaves with a voxel that is not free, in the order of the regions
  /// Tiles of unknown voxels, clipped to the workspace. Tiles larger than a region come first:
  /// those of 2048³ voxels, then those of 128³, each sorted by x, y, z. The others follow in the
  /// order of the regions.
  std::vector<VoxelBox> tiles;
  std::vector<Region> regions;  ///< cubes of 32³ voxels with leaves or tiles, by increasing number
  /// Identifies the grid, for BeliefGrid::snapshot(before); 0: none.
  std::uint64_t grid_number = 0;
  std::uint64_t time = 0;  ///< time of the grid's last change
  /// For a snapshot made from an earlier one, the time of that one; otherwise 0.
  std::uint64_t shared_until = 0;

  /// Whether the region is unchanged since the earlier snapshot, if this snapshot was made from
  /// one.
  [[nodiscard]] bool is_shared(const Region& region) const {
    return shared_until != 0 && region.changed <= shared_until;
  }

  /// The voxel that contains a point p_world [m]; empty outside the workspace or if the point is
  /// not finite.
  [[nodiscard]] std::optional<Index3> index_of(const Eigen::Vector3d& p_world) const;
  /// Centre of a voxel in the world [m].
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;

  /// The leaf that contains a voxel, or null. O(log regions).
  [[nodiscard]] const Leaf* find_leaf(Index3 voxel) const;

  /// Whether the voxel is neither unknown nor occupied; true outside the workspace. O(log regions +
  /// log tiles).
  [[nodiscard]] bool is_free(Index3 voxel) const;

  /// First and one past the last leaf of a region, by the region's index in the list.
  [[nodiscard]] std::array<std::uint32_t, 2> leaves_of(std::size_t region) const {
    return {regions[region].first_leaf, region + 1 < regions.size()
                                            ? regions[region + 1].first_leaf
                                            : static_cast<std::uint32_t>(leaves.size())};
  }
  /// First and one past the last tile of a region, by the region's index in the list.
  [[nodiscard]] std::array<std::uint32_t, 2> tiles_of(std::size_t region) const {
    return {regions[region].first_tile, region + 1 < regions.size()
                                            ? regions[region + 1].first_tile
                                            : static_cast<std::uint32_t>(tiles.size())};
  }
};

}  // namespace viewgain
