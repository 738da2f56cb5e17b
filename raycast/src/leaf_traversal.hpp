// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "embree_compat.hpp"
#include "ray_tile.hpp"
#include "viewgain/core/isa.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

/// The tracing kernels of one instruction set.
struct TraceKernels {
  Isa isa;
  int width;  ///< rays a packet: 4, 8 or 16

  /// Embree's callbacks for leaf masks and for boxes.
  RTCIntersectFunctionN intersect_leaf;
  RTCIntersectFunctionN intersect_box;

  /// Sets up tile number `tile` of the table for a pose and traces it through the scene's BVH.
  void (*trace)(const VoxelScene::Data& scene, const TileTable& table, const PoseFrame& frame,
                std::size_t tile, RayTile& out);

  /// The same answer, obstacles apart, from a list of primitives that holds all that the tile's
  /// rays meet, in any order, without the BVH.
  void (*trace_list)(const VoxelScene::Data& scene, const TileTable& table, const PoseFrame& frame,
                     std::size_t tile, std::span<const std::uint32_t> primitives, RayTile& out);
};

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const TraceKernels& trace_kernels(Isa isa);

}  // namespace viewgain::detail
