// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain::app {

/// As many cubes as a picture has room for.
inline constexpr std::size_t kMaxCubes = 400'000;

/// Cubes of one lattice in the grid's frame; cube i reaches from side * at[i] to side * (at[i] + 1)
/// [m].
struct LatticeCubes {
  std::vector<Index3> at;  ///< rising
  double side = 0;         ///< [m]
};

/// The occupied voxels as at most `most` cubes: two by two by two become one until they are few
/// enough.
[[nodiscard]] LatticeCubes occupied_cubes(const GridSnapshot& snapshot, std::size_t most);

}  // namespace viewgain::app
