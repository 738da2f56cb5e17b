// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/grid/occupancy_codes.hpp"
#include "viewgain/raycast/classic_gains.hpp"

namespace viewgain::detail {

/// What voxels weigh by the code of their log-odds, for one semantics.
struct VoxelValues {
  /// Most voxels that a ray meets of an aligned cube of 32³ without leaving it: 3 · 32 - 2.
  static constexpr std::size_t kMostInCube = 94, kRow = kMostInCube + 1;
  /// What voxels count as.
  static constexpr std::uint8_t kIsUnknown = 1, kIsFree = 2, kIsOccupied = 4;

  std::array<double, OccupancyCodes::kCount> entropy{};  ///< H [nat]
  std::array<std::uint8_t, OccupancyCodes::kCount> kinds{};
  /// Of n voxels of a code in a row, at code * kRow + n: Σ_{k<n} q^k H and q^n, q being what each
  /// lets through.
  std::vector<double> sums, powers;

  explicit VoxelValues(const ClassicConfig& config);
};

}  // namespace viewgain::detail
