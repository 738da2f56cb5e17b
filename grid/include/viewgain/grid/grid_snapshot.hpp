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

/// Everything a scene reads of a grid: an immutable value, safe to share between threads. Members
/// check nothing: a region's place must be one in the list.
struct VIEWGAIN_EXPORT GridSnapshot {
  /// A leaf with at least one voxel that is not free, clipped to the workspace.
  struct Leaf {
    Index3 origin;        ///< lowest voxel, a multiple of 8
    LeafMask non_free{};  ///< unknown or occupied
    LeafMask occupied{};  ///< of the voxels that are not free, the occupied ones
    std::shared_ptr<const BeliefBlock> beliefs;  ///< null without occupied voxels; else may be
                                                 ///< null, may hold free voxels' beliefs too
  };
  /// A cube of 32³ voxels of the lattice; its leaves and tiles follow one another in the lists.
  struct Region {
    std::uint64_t number = 0;  ///< lists of regions rise in it; the same in all snapshots of a grid
    std::uint64_t changed = 0;     ///< when its voxels changed last
    std::uint32_t first_leaf = 0;  ///< a region's leaves rise in their origin's x, then y, then z
    std::uint32_t first_tile = 0;  ///< of this region, in the list of tiles
  };

  double voxel_size = 0;     ///< [m]
  double prior_sigma = 0;    ///< [m]
  Pose T_world_grid;         ///< places the grid's frame
  Index3 min_index;          ///< lowest voxel of the workspace
  Index3 dims;               ///< voxels along x, y, z
  HazardCounters hazard;     ///< what frames have said of unknown space
  std::vector<Leaf> leaves;  ///< with a voxel that is not free, in the order of the regions
  /// Of unknown voxels, clipped to the workspace; those larger than a region first, by the nodes of
  /// 2048³ and then 128³ voxels that they fill, each by x, y, z; then in the order of the regions.
  std::vector<VoxelBox> tiles;
  std::vector<Region> regions;  ///< cubes of 32³ voxels that hold any, numbers rising
  /// Which grid it is of and when, for BeliefGrid::snapshot(before); 0: none.
  std::uint64_t grid_number = 0;
  std::uint64_t time = 0;  ///< of the grid's last change
  /// For a snapshot made from an earlier one: when that was; else 0.
  std::uint64_t shared_until = 0;

  /// Is the region as it was in that earlier snapshot, provided that it is listed there?
  [[nodiscard]] bool is_shared(const Region& region) const {
    return shared_until != 0 && region.changed <= shared_until;
  }

  /// The voxel that holds a point p_world [m]; nothing outside the workspace, or if it is not
  /// finite.
  [[nodiscard]] std::optional<Index3> index_of(const Eigen::Vector3d& p_world) const;
  /// Centre of a voxel in the world [m].
  [[nodiscard]] Eigen::Vector3d center(Index3 voxel) const;

  /// The leaf that holds a voxel, null if there is none. O(log regions).
  [[nodiscard]] const Leaf* find_leaf(Index3 voxel) const;

  /// Is the voxel neither unknown nor occupied? So is all outside the workspace. O(log regions +
  /// log tiles).
  [[nodiscard]] bool is_free(Index3 voxel) const;

  /// The [first, last) leaves and tiles of a region, by its place in the list.
  [[nodiscard]] std::array<std::uint32_t, 2> leaves_of(std::size_t region) const {
    return {regions[region].first_leaf, region + 1 < regions.size()
                                            ? regions[region + 1].first_leaf
                                            : static_cast<std::uint32_t>(leaves.size())};
  }
  /// First and one past the last of a region's tiles.
  [[nodiscard]] std::array<std::uint32_t, 2> tiles_of(std::size_t region) const {
    return {regions[region].first_tile, region + 1 < regions.size()
                                            ? regions[region + 1].first_tile
                                            : static_cast<std::uint32_t>(tiles.size())};
  }
};

}  // namespace viewgain
