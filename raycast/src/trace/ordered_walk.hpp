// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ray_tile.hpp"
#include "scene/brick_table.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/walk_task.hpp"

namespace viewgain::detail {

/// What new surface at range t counts for, a pixel of solid angle ω: min(ω t², cap) ρ(t), with
/// ρ(t) = scale / (1 + s) and s = s0 + s1 t + s2 (t - at)² (ReadingWorth). Lengths in voxels.
struct PixelWorth {
  float cap, scale, s0, s1, s2, at;
};

/// What the rays of a tile meet, and where they end. Lengths in voxels, areas in voxels².
struct alignas(64) WalkedTile {
  /// What is left of the ray at its end: T, the chance that it gets there.
  float passed[kTileRays];
  /// Σ P min(ω t², cap) ρ(t) over its runs: the new surface to be expected, across the ray.
  float area[kTileRays];
  /// Of the last stretch of unknown voxels, without a free one in between: its share of the area;
  /// the same as if all surface in it were new; the chance to end in it of a ray that gets there;
  /// its length. The chance is a sum of small ones: as 1 - T it would be lost where the hazard is
  /// low.
  float stretch_area[kTileRays], stretch_all[kTileRays], stretch_chance[kTileRays],
      stretch_length[kTileRays];
  float range[kTileRays];                                 ///< where a ray ends that is `occupied`
  std::int32_t x[kTileRays], y[kTileRays], z[kTileRays];  ///< its voxel, in table coordinates
  std::uint32_t occupied = 0;                             ///< lanes that end in an occupied voxel
};

/// A voxel that a ray visits for a positive length.
struct VoxelVisit {
  std::uint32_t lane;
  std::uint32_t state;   ///< as in BrickTable: unknown or occupied; free ones are left out
  std::int32_t x, y, z;  ///< table coordinates
  float begin, end;      ///< along the ray [voxels]
  float rate;            ///< [1/voxel], signed as in BrickTable::records; unknown voxels only
};

/// Walks rays through the bricks in order, through unknown voxels to the first occupied one or the
/// end of what is to be seen.
struct WalkKernels {
  /// For tiles, two at a time at best: `out` has as many. `worth`: what P is multiplied by.
  /// `missed`: what of a hazard cell's area counts, by BrickTable::place_of(); null: all.
  void (*area)(const BrickTable& table, const WalkLimits& limits, std::span<const WalkTask> tasks,
               const PixelWorth& worth, const float* missed, WalkedTile* out);
  /// Voxel by voxel: appends what the rays of a tile visit, each ray's in order.
  void (*visits)(const BrickTable& table, const WalkLimits& limits, const WalkTask& task,
                 std::vector<VoxelVisit>& out);
};

/// Where a view's rays may go in a scene.
[[nodiscard]] WalkLimits walk_limits(const SceneData& scene, const PoseFrame& frame);

/// A tile's rays that end in a voxel, to be walked on from there, as far as is known.
void set_up(const TileTable& table, std::size_t number, const PoseFrame& frame, const RayTile& rays,
            WalkTask& task);

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const WalkKernels& walk_kernels(Isa isa);

}  // namespace viewgain::detail
