// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "classic_table.hpp"
#include "distinct_voxels.hpp"
#include "trace/ray_tile.hpp"
#include "viewgain/core/isa.hpp"
#include "voxel_values.hpp"

namespace viewgain::detail {

/// What all gains of a view are made of. Lengths in voxels.
struct ClassicSums {
  double occlusion_aware = 0, unobserved = 0;
  double entropy = 0, voxels = 0;  ///< of what average_entropy counts
  double rear_side_entropy = 0;
  double proximity = 0;
  double volume = 0;  ///< Σ ω (exit³ - enter³) / 3
  std::uint64_t rear_side = 0;
  std::uint64_t on_surface = 0, on_hidden = 0;  ///< rays of area_factor's classes
};

/// A tile of rays in table coordinates [voxels].
struct alignas(64) ClassicTile {
  double dx[kTileRays], dy[kTileRays], dz[kTileRays];  ///< unit directions, grid frame
  double far[kTileRays];                               ///< where each ray must end
  const float* solid_angle = nullptr;                  ///< what each stands for [sr]
  std::uint32_t valid = 0;                             ///< one bit a lane
};

/// What a view's tiles have in common.
struct ClassicView {
  const ClassicTable& table;
  const VoxelValues& values;
  std::array<double, 3> origin{};  ///< of the rays
  double min_range = 0;
  double most_steps = 0;     ///< proximity_count: what a voxel's steps are taken from
  bool is_shipped = false;   ///< average_entropy and rear_side_entropy differ
  bool is_distinct = false;  ///< are distinct unknown voxels asked for?
};

/// Walks the rays of a tile, in order through all voxels, and adds what they meet.
using AddTile = void (*)(const ClassicView& view, const ClassicTile& tile, ClassicSums& sums,
                         DistinctVoxels& distinct);

/// For an instruction set that the CPU supports.
[[nodiscard]] AddTile classic_walk(Isa isa);

}  // namespace viewgain::detail
