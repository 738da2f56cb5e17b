// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "program/cli/json.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::app {

/// What a call says in JSON of a map that it has written.
[[nodiscard]] inline Json map_json(const BeliefGrid& grid,
                                   const BeliefGrid::Statistics& statistics) {
  const Index3 dims = grid.dims();
  return {{"voxel_size", grid.voxel_size()},  {"workspace", to_json(grid.workspace())},
          {"dims", {dims.x, dims.y, dims.z}}, {"prior_sigma", grid.prior_sigma()},
          {"unknown", statistics.unknown},    {"free", statistics.free},
          {"occupied", statistics.occupied}};
}

/// Warns on stderr of what a tree cannot hold, where save_map lost it.
inline void warn_of_lost_frame(const LostInTree& lost, const std::string& path) {
  if (!lost.T_world_grid) return;
  std::fprintf(stderr,
               "viewgain: warning: %s: the tree is in the map's own frame: T_world_grid, which is "
               "no shift by whole voxels within a tree's space, is lost\n",
               path.c_str());
}

}  // namespace viewgain::app
