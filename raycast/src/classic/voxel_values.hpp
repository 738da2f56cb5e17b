// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "viewgain/grid/occupancy_codes.hpp"
#include "viewgain/raycast/classic_gains.hpp"

namespace viewgain::detail {

/// What voxels weigh by the code of their log-odds, for one semantics.
struct VoxelValues {
  /// What n voxels of a code in a row add to a ray, q being what each lets through.
  struct Run {
    double visible;  ///< Σ_{k<n} q^k H
    double passed;   ///< q^n
    double entropy;  ///< n H
    double unused;
  };
  /// A ray meets at most 3 · 32 - 2 voxels of an aligned cube of 32³ without leaving it.
  static constexpr int kRowBits = 7;
  static constexpr int kRunDoubles = 4;

  std::vector<Run> runs;  ///< at code << kRowBits | n
  /// Known voxels count as free below, as occupied from there on; others, and those that no reading
  /// told of, as unknown.
  std::int64_t free_end = 0, occupied_begin = 0;

  explicit VoxelValues(const ClassicConfig& config);
};

}  // namespace viewgain::detail
