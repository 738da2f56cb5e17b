// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"

namespace viewgain::bench {

/// Three walks through a MaskTree of the voxels that are not free, with an accessor, from the ray's
/// entry into the workspace:
/// - `openvdb_dda`: math::DDA, voxel by voxel
/// - `openvdb_hdda`: math::VolumeHDDA through nodes and leaves to the next run of leaves and active
///   tiles, then voxel by voxel
/// - `nanovdb_hdda`: nanovdb::HDDA, with steps as long as the node or tile
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_openvdb_methods(const TraceTask& task);

}  // namespace viewgain::bench
