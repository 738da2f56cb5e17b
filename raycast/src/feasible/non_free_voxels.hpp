// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <vector>

#include "oriented_box.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain::detail {

/// Spatial index of the voxels of a snapshot that are not free, by cubes of 128³, 32³ and 8³
/// voxels. Lengths in voxels, grid frame. The constructor only reads the list of regions and the
/// larger tiles; the contents of a region are read on the first query. Thread safe.
class NonFreeVoxels {
 public:
  /// The snapshot must outlive it.
  explicit NonFreeVoxels(const GridSnapshot& snapshot);

  [[nodiscard]] bool overlap(const OrientedBox& body) const;

  /// Whether a point is in voxels that are not free, on whichever side of a face it lies.
  [[nodiscard]] bool enclose(const Eigen::Vector3d& point, double touch) const;

  /// Whether a cone can contain such voxels within a distance of its tip. Checks blocks of 8³
  /// voxels that have some.
  struct Cone {
    Eigen::Vector3d tip, axis;  ///< the axis has unit length
    double sine, cosine;        ///< of the angle between axis and side
  };
  [[nodiscard]] bool may_meet(const Cone& cone, const Box& range) const;

  /// Distance at which the half-line (unit direction) first enters such a voxel, or `begin` if it
  /// starts in one. Infinity if there is none between `begin` and `end`. Crossings of zero length
  /// do not count.
  [[nodiscard]] double first_along(const HalfLine& line, double begin, double end) const;

 private:
  /// A cube of 128³ voxels. Bits are regions: x << 4 | y << 2 | z, two bits each.
  struct Node {
    Index3 origin;
    std::uint64_t listed = 0;  ///< regions in the snapshot's list
    std::uint64_t in_use = 0;  ///< regions that have leaves or tiles
    std::uint32_t first = 0;   ///< index of the first one in that list

    [[nodiscard]] std::uint32_t place(unsigned region) const;
  };
  /// Blocks of 8³ voxels in a region that have such voxels, bits as above: leaves in the snapshot's
  /// order, and entirely unknown blocks.
  struct Blocks {
    std::uint64_t leaves = 0, tiles = 0;
  };
  struct KnownBlocks {
    std::atomic<bool> is_known{false};
    std::atomic<std::uint64_t> leaves{0}, tiles{0};
  };

  [[nodiscard]] const Node* find_node(const Index3& voxel) const;
  [[nodiscard]] Blocks blocks_of(std::uint32_t region) const;
  /// The leaf of a block; there must be one.
  [[nodiscard]] const GridSnapshot::Leaf& leaf_at(std::uint32_t region, const Blocks& blocks,
                                                  unsigned block) const;
  [[nodiscard]] bool contains(const Index3& voxel) const;
  template <typename Visit>
  [[nodiscard]] bool any_region(const Box& range, const Visit& visit) const;
  template <typename LeafVisit, typename TileVisit>
  [[nodiscard]] bool any_block(const Box& range, const LeafVisit& leaf_visit,
                               const TileVisit& tile_visit) const;

  const GridSnapshot& snapshot_;
  VoxelBox workspace_;
  BoxHierarchy large_;  ///< tiles larger than a region
  std::vector<Node> nodes_;
  mutable std::vector<KnownBlocks> blocks_;  ///< per region of the list
};

}  // namespace viewgain::detail
