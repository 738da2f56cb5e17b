// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "embree_compat.hpp"
#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "tile_bins.hpp"
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

  /// Traces the tile through a list of primitives, in any order but for their `near`, without the
  /// BVH; lists may follow one another. When they hold all that the tile's rays meet the answer is
  /// that of `trace`. `cosine`: no ray of the tile makes a smaller angle with the
  /// optical axis. Returns how far along the axis something must begin to be of no more interest.
  float (*walk)(const SceneData& scene, const PoseFrame& frame, float cosine,
                std::span<const TileBox> primitives, RayTile& out);
};

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const TraceKernels& trace_kernels(Isa isa);

}  // namespace viewgain::detail
