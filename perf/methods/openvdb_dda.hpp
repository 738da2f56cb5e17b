// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace_method.hpp"

namespace viewgain::bench {

/// OpenVDB's math::DDA with a value accessor over a mask tree whose active voxels are the non-free
/// ones, from the ray's entry into the workspace.
[[nodiscard]] std::unique_ptr<TraceMethod> make_openvdb_dda(const TraceTask& task);

}  // namespace viewgain::bench
