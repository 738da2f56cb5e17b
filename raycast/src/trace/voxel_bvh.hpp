// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device.hpp"
#include "viewgain/core/isa.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

/// A scene's primitives and obstacles in Embree's BVH.
struct VoxelBvh {
  DevicePtr device;
  ScenePtr scene;  ///< released before the device
};

/// The best instruction set, within VIEWGAIN_ISA, for which Embree has packets of the kernels'
/// width. Throws Error(backend) if there is none.
[[nodiscard]] Isa packet_isa();

/// About 0.3 ms per 1,000 primitives. Throws Error(backend), Error(capacity).
[[nodiscard]] VoxelBvh build_bvh(const VoxelScene::Data& data);

}  // namespace viewgain::detail
