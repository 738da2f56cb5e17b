// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "classic_table.hpp"
#include "distinct_voxels.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/walk_task.hpp"
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

/// What all views of a map have in common.
struct ClassicView {
  const ClassicTable& table;
  const VoxelValues& values;
  double most_steps = 0;     ///< proximity_count: what a voxel's steps are taken from
  bool is_shipped = false;   ///< average_entropy and rear_side_entropy differ
  bool is_distinct = false;  ///< are distinct unknown voxels asked for?
};

/// Walks of a tile's rays through a ClassicTable.
struct ClassicKernels {
  /// In order through all voxels to the first occupied one: adds what they meet.
  void (*add)(const ClassicView& view, const WalkLimits& limits, const WalkTask& task,
              ClassicSums& sums, DistinctVoxels& distinct);
  /// To the first occupied voxel and `depth` [voxels] on: marks which unknown ones are how many
  /// steps behind. Changes `task`.
  void (*mark_hidden)(const ClassicTable& table, const WalkLimits& limits, float depth,
                      WalkTask& task, OcclusionSteps& steps);
};

/// For an instruction set that the CPU supports.
[[nodiscard]] const ClassicKernels& classic_kernels(Isa isa);

}  // namespace viewgain::detail
