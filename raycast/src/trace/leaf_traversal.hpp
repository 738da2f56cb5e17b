// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "embree_compat.hpp"
#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/isa.hpp"

namespace viewgain::detail {

/// Geometry numbers in the Embree scene.
inline constexpr unsigned kLeafGeometry = 0;
inline constexpr unsigned kBoxGeometry = 1;

/// The tracing kernels of one instruction set.
struct TraceKernels {
  Isa isa;
  int width;  ///< rays a packet: 4, 8 or 16

  /// Embree's callbacks for leaf masks and for boxes.
  RTCIntersectFunctionN intersect_leaf;
  RTCIntersectFunctionN intersect_box;

  /// Sets up tile number `tile` of the table for a pose: it has met nothing yet.
  void (*begin)(const TileTable& table, const PoseFrame& frame, std::size_t tile, RayTile& out);

  /// Traces the tile through the scene's BVH.
  void (*trace)(const SceneData& scene, RTCScene bvh, const PoseFrame& frame, RayTile& out);

  /// Traces the tile through one primitive. After all that its rays meet, in any order, the answer
  /// is that of `trace`.
  void (*visit)(const SceneData& scene, const PoseFrame& frame, std::uint32_t primitive,
                RayTile& out);
};

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const TraceKernels& trace_kernels(Isa isa);

}  // namespace viewgain::detail
