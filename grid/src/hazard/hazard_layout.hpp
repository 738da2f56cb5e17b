// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "viewgain/grid/hazard.hpp"

namespace viewgain::detail {

/// Where the hazard of a map is computed: model, evidence, and the cells within the cut of it.
struct HazardLayout {
  /// Throws like HazardField.
  HazardLayout(const GridSnapshot& snapshot, const HazardConfig& config);

  Pooling pooling;
  std::vector<Index3> evidence;  ///< voxels
  HazardConfig::Model model;
  bool follows_counters = false;
  int shift = 0;                 ///< log2 of the edge of cells [voxels]
  VoxelBox cells;                ///< in the workspace; empty without evidence [cells]
  VoxelBox voxels;               ///< of these cells
  int reach = 0;                 ///< the cut [cells]
  int open_reach = 0;            ///< HazardConfig::Model::kOpenReach [cells]
  std::uint32_t most_known = 0;  ///< up to this squared distance, surface is not new [cells²]

  /// The cell of a voxel, as an index of the lattice of cells.
  [[nodiscard]] Index3 cell_of(Index3 v) const {
    return {v.x >> shift, v.y >> shift, v.z >> shift};
  }
};

}  // namespace viewgain::detail
