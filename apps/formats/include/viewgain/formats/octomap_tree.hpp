// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Octrees in memory. The target viewgain::octomap brings OctoMap's headers and library along; this
// header is all of it, so that it fits whichever OctoMap its user has.

#include <octomap/OcTree.h>

#include <locale>
#include <memory>
#include <sstream>
#include <string>

#include "viewgain/formats/octomap_io.hpp"

namespace viewgain {

/// A belief grid of the tree, by the rules of load_octomap; a voxel is occupied where the tree says
/// so (its own occupancy threshold, instead of config.occupied_from). Passes through the tree's
/// file form in memory: 5 bytes a node. Thread safety: reads the tree only. Throws as load_octomap.
/// Cost: O(nodes).
[[nodiscard]] inline BeliefGrid grid_from_octree(const octomap::OcTree& tree,
                                                 OctomapConfig config = {}) {
  config.occupied_from = tree.getOccupancyThresLog();
  std::ostringstream file;
  file.imbue(std::locale::classic());
  file.precision(17);  // so that the resolution is the tree's
  tree.write(file);
  return grid_from_octomap_bytes(file.str(), config, "octomap::OcTree");
}

/// The tree that save_octomap would write, with OctoMap's default settings but for the resolution.
/// Throws as save_octomap. Cost: O(nodes).
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
