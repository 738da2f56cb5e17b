// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// What a tile of rays is, by one instruction set.
struct TileKernels {
  Isa isa;
  int width;  ///< rays a vector: 4, 8 or 16

  /// Sets up tile number `tile` of the table for a pose: it has met nothing yet.
  void (*begin)(const TileTable& table, const PoseFrame& frame, std::size_t tile, RayTile& out);

  /// Leads the tile through one primitive. After all that its rays meet, in any order, the answer
  /// is that of tracing.
  void (*visit)(const SceneData& scene, const PoseFrame& frame, std::uint32_t primitive,
                RayTile& out);

  /// Ends the tile's rays at the voxels of `mask`, some of a leaf's, that they enter before
  /// min_range: as at an obstacle.
  void (*block)(const SceneData& scene, const PoseFrame& frame, std::uint32_t leaf,
                const TraceMask& mask, RayTile& out);
};

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const TileKernels& tile_kernels(Isa isa);

}  // namespace viewgain::detail
