// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace_method.hpp"

namespace viewgain::bench {

/// A hierarchical DDA over dense arrays, without a BVH (see dense_grid.hpp). It uses SIMD with one
/// ray per lane, for tiles of 4×4 pixels.
[[nodiscard]] std::unique_ptr<TraceMethod> make_dense_dda(const TraceTask& task);

}  // namespace viewgain::bench
