// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace_method.hpp"

namespace viewgain::bench {

/// `tree64`: a sparse tree of nodes with 4³ children, a bit each, as renderers of voxels use it,
/// written for this comparison. A ray steps from empty cell to empty cell, of the largest size, or
/// over 2³ empty ones together, and keeps the nodes above it on a stack; single precision, a ray at
/// a time. Plane distances are (plane - origin) / direction with exact planes.
[[nodiscard]] std::unique_ptr<TraceMethod> make_tree64_method(const TraceTask& task);

}  // namespace viewgain::bench
