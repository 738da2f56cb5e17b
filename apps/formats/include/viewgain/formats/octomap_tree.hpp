// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Octrees in memory. Header-only, so it works with any version of OctoMap. The target
// viewgain::octomap provides OctoMap's headers and library.

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <locale>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain {

/// A belief grid from the tree, like load_octomap(). The tree's own occupancy threshold replaces
/// config.occupied_from. Needs 5 bytes per node for a temporary copy. Thread safety: only reads the
/// tree. Throws whatever load_octomap() throws. Cost: O(nodes).
[[nodiscard]] inline BeliefGrid grid_from_octree(const octomap::OcTree& tree,
                                                 OctomapConfig config = {}) {
  config.occupied_from = tree.getOccupancyThresLog();
  std::ostringstream file;
  file.imbue(std::locale::classic());
  file.precision(17);  // so that the resolution equals the tree's
  tree.write(file);
  return grid_from_octomap_bytes(file.str(), config, "octomap::OcTree");
}

/// Labels of a box of voxels, [x][y][z] with z fastest: 0 unknown, 1 free, 2 occupied.
struct OctreeLabels {
  VoxelBox box;                      ///< on the lattice of the grid
  std::vector<std::uint8_t> labels;  ///< one per voxel of the box
};

/// Labels from the tree for a map with this `voxel_size` [m] and `workspace`. `region` is in the
/// tree's frame [m], for example around the changes of insertPointCloud(). Its part outside the
/// workspace is ignored. Throws Error(invalid_argument) unless the voxel sizes are equal. Cost:
/// O(nodes and voxels in the box).
[[nodiscard]] inline OctreeLabels labels_of_octree(double voxel_size, const VoxelBox& workspace,
                                                   const octomap::OcTree& tree, const Box& region) {
  const double V = tree.getResolution();
  if (std::abs(voxel_size - V) > 1e-9 * V)
    refuse("the tree and the grid must have the same voxel size");
  const auto index = [&](double x) {
    return static_cast<std::int32_t>(std::clamp(std::floor(x / V), -32768.0, 32767.0));
  };
  const VoxelBox wanted{
      {index(region.min[0]), index(region.min[1]), index(region.min[2])},
      {index(region.max[0]) + 1, index(region.max[1]) + 1, index(region.max[2]) + 1}};
  const VoxelBox box = wanted.intersection(workspace);
  if (box.volume() == 0) return {};
  const auto ny = static_cast<std::size_t>(box.max.y - box.min.y),
             nz = static_cast<std::size_t>(box.max.z - box.min.z);
  std::vector<std::uint8_t> states(box.volume(), 0);
  const auto key_of = [](Index3 v) {
    const auto part = [](std::int32_t i) { return static_cast<octomap::key_type>(i + 32768); };
    return octomap::OcTreeKey(part(v.x), part(v.y), part(v.z));
  };
  const octomap::OcTreeKey low = key_of(box.min),
                           high = key_of({box.max.x - 1, box.max.y - 1, box.max.z - 1});
  for (auto leaf = tree.begin_leafs_bbx(low, high), end = tree.end_leafs_bbx(); leaf != end;
       ++leaf) {
    // A pruned leaf is a cube of voxels.
    const int edge = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const auto lattice = [](octomap::key_type k) { return static_cast<std::int32_t>(k) - 32768; };
    const VoxelBox part =
        VoxelBox::from_dims({lattice(key[0]), lattice(key[1]), lattice(key[2])}, {edge, edge, edge})
            .intersection(box);
    const std::uint8_t state = tree.isNodeOccupied(*leaf) ? 2 : 1;
    for (std::int32_t x = part.min.x; x < part.max.x; ++x) {
      for (std::int32_t y = part.min.y; y < part.max.y; ++y) {
        const std::size_t at = (static_cast<std::size_t>(x - box.min.x) * ny +
                                static_cast<std::size_t>(y - box.min.y)) *
                                   nz +
                               static_cast<std::size_t>(part.min.z - box.min.z);
        std::fill_n(states.begin() + static_cast<std::ptrdiff_t>(at), part.max.z - part.min.z,
                    state);
      }
    }
  }
  return {box, std::move(states)};
}

/// Updates a scorer's map from a growing tree. Returns the number of changed voxels. Errors and
/// cost: see labels_of_octree() and ViewScorer::set().
inline std::uint64_t update_from_octree(ViewScorer& scorer, const octomap::OcTree& tree,
                                        const Box& region) {
  const OctreeLabels now =
      labels_of_octree(scorer.config().voxel_size, scorer.voxels(), tree, region);
  return now.labels.empty() ? 0 : scorer.set(now.box, now.labels);
}
/// As above for a grid.
inline std::uint64_t update_from_octree(BeliefGrid& grid, const octomap::OcTree& tree,
                                        const Box& region) {
  const OctreeLabels now = labels_of_octree(
      grid.voxel_size(), VoxelBox::from_dims(grid.min_index(), grid.dims()), tree, region);
  return now.labels.empty() ? 0 : grid.update_box(now.box, now.labels);
}

/// The tree that save_octomap() would write, with OctoMap's default settings except the resolution.
/// Throws whatever save_octomap() throws. Cost: O(nodes).
[[nodiscard]] inline std::unique_ptr<octomap::OcTree> octree_from_grid(const BeliefGrid& grid) {
  std::istringstream file(octomap_bytes(grid));
  file.imbue(std::locale::classic());
  auto tree = std::make_unique<octomap::OcTree>(grid.voxel_size());
  for (std::string line; std::getline(file, line) && line != "data";) {
  }
  if (file.peek() != std::istringstream::traits_type::eof()) tree->readData(file);
  return tree;
}

}  // namespace viewgain
