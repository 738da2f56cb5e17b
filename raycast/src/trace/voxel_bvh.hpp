// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device.hpp"
#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// Packets of rays through a BVH of voxels, by one instruction set.
struct PacketKernels {
  int width;  ///< rays a packet: 4, 8 or 16

  /// Embree's callbacks for leaf masks and for boxes.
  RTCIntersectFunctionN intersect_leaf;
  RTCIntersectFunctionN intersect_box;

  /// Traces a tile that has been set up.
  void (*trace)(const SceneData& scene, RTCScene bvh, const PoseFrame& frame, RayTile& out);
};

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const PacketKernels& packet_kernels(Isa isa);

/// The best instruction set, `isa` at most, for which Embree has packets of the kernels' width.
/// Throws Error(backend) if there is none.
[[nodiscard]] Isa packet_isa(Isa isa);

/// A scene's primitives in Embree's BVH, for packets of this instruction set; boxes count as larger
/// by `margin` [voxels], against rounding. About 0.5 ms per 1,000 primitives. Throws
/// Error(backend), also where Embree has no such packets.
[[nodiscard]] ScenePtr build_bvh(const SceneData& data, Isa isa, float margin);

}  // namespace viewgain::detail
