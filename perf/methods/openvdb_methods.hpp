// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"

namespace viewgain::bench {

/// Walks over a MaskTree of the voxels that are not free, with a value accessor, from the ray's
/// entry into the workspace. `openvdb_dda`: math::DDA, voxel by voxel. `openvdb_hdda`:
/// math::VolumeHDDA through nodes and leaves to the next stretch of leaves and active tiles, there
/// voxel by voxel. `nanovdb_hdda`: nanovdb::HDDA over the same as a NanoVDB grid, its step as wide
/// as the node or tile that the ray is in (a fused walk of all levels); 1e-6 voxel beyond each
/// face, where NanoVDB's own firstActive() goes a whole voxel on and misses some.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_openvdb_methods(const TraceTask& task);

}  // namespace viewgain::bench
