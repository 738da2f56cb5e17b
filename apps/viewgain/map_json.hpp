// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::app {

/// What a call says in JSON of a map that it has written.
[[nodiscard]] inline nlohmann::ordered_json map_json(const BeliefGrid& grid,
                                                     const GridStatistics& statistics) {
  const Index3 dims = grid.dims();
  return {{"voxel_size", grid.voxel_size()},  {"workspace", to_json(grid.workspace())},
          {"dims", {dims.x, dims.y, dims.z}}, {"prior_sigma", grid.prior_sigma()},
          {"unknown", statistics.unknown},    {"free", statistics.free},
          {"occupied", statistics.occupied}};
}

}  // namespace viewgain::app
