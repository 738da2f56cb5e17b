// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// JSON about a map that a call has written.
[[nodiscard]] inline Json map_json(const BeliefGrid& grid,
                                   const BeliefGrid::Statistics& statistics) {
  const Index3 dims = grid.dims();
  return {{"voxel_size", grid.voxel_size()},  {"workspace", to_json(grid.workspace())},
          {"dims", {dims.x, dims.y, dims.z}}, {"prior_sigma", grid.prior_sigma()},
          {"unknown", statistics.unknown},    {"free", statistics.free},
          {"occupied", statistics.occupied}};
}

/// Prints the same as two lines.
inline void print_map(const BeliefGrid& grid, const BeliefGrid::Statistics& statistics) {
  const Index3 dims = grid.dims();
  std::printf("workspace %s m (grid frame): %d x %d x %d voxels of %g m, prior sigma %g m\n",
              describe(grid.workspace()).c_str(), dims.x, dims.y, dims.z, grid.voxel_size(),
              grid.prior_sigma());
  std::printf(
      "voxels: %s unknown (%.1f %%), %s free, %s occupied\n",
      with_commas(statistics.unknown).c_str(),
      100 * static_cast<double>(statistics.unknown) / static_cast<double>(grid.voxel_count()),
      with_commas(statistics.free).c_str(), with_commas(statistics.occupied).c_str());
}

/// Warns on stderr of contents that save_map() lost, because a tree cannot store them.
inline void warn_of_lost_frame(const LostInTree& lost, const std::string& path) {
  if (!lost.T_world_grid) return;
  std::fprintf(
      stderr,
      "viewgain: warning: %s: T_world_grid is lost, so the tree is in the map's grid frame; "
      "a tree can only be shifted by whole voxels\n",
      path.c_str());
}

}  // namespace viewgain::app
