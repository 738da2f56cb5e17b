// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "trace_method.hpp"

namespace viewgain::bench {

/// A hierarchical DDA over dense arrays, no BVH: see dense_grid.hpp. SIMD, a ray a lane, tiles of
/// 4×4 pixels.
[[nodiscard]] std::unique_ptr<TraceMethod> make_dense_dda(const TraceTask& task);

}  // namespace viewgain::bench
