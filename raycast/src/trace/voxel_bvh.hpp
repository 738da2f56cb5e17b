// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device.hpp"
#include "leaf_traversal.hpp"
#include "scene/scene_data.hpp"

namespace viewgain::detail {

/// A scene's primitives in Embree's BVH, for rays of these kernels; boxes count as larger by
/// `margin` [voxels], against rounding. About 0.3 ms per 1,000 primitives. Throws
/// Error(backend), Error(capacity).
[[nodiscard]] ScenePtr build_bvh(const SceneData& data, const TraceKernels& kernels, float margin);

}  // namespace viewgain::detail
