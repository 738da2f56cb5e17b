// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace_method.hpp"

namespace viewgain::bench {

/// `tree64`: a sparse tree of nodes with 4³ children, one bit per child, as in voxel renderers.
/// Written for this comparison. A ray steps over the largest empty cell, or over 2³ empty cells
/// together, and keeps the nodes above it on a stack. It uses single precision, one ray at a time.
/// Plane distances are (plane - origin) / direction with exact planes.
[[nodiscard]] std::unique_ptr<TraceMethod> make_tree64_method(const TraceTask& task);

}  // namespace viewgain::bench
