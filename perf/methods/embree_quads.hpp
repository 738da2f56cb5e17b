// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"

namespace viewgain::bench {

/// Embree over the map's exposed faces as quads, greedily merged, built with high quality: all four
/// combinations of coherent and incoherent rays and of packets of 8 (4x2 pixels) and 16 (4x4
/// pixels). Tracing only. Rays must start outside the non-free voxels.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_embree_quads(const TraceTask& task);

}  // namespace viewgain::bench
