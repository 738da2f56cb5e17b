// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace_method.hpp"

namespace viewgain::bench {

/// `nanovdb_hdda`: nanovdb::HDDA over a grid of the voxels that are not free, its step as wide as
/// the node or tile that the ray is in (a fused walk of all levels, with a read accessor), from the
/// ray's entry into the workspace. In double precision, and 1e-6 voxel beyond each face, where
/// NanoVDB's own firstActive() goes a whole voxel on and misses some.
[[nodiscard]] std::unique_ptr<TraceMethod> make_nanovdb_method(const TraceTask& task);

}  // namespace viewgain::bench
