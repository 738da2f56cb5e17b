// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"

namespace viewgain::bench {

/// Embree over the map's exposed faces as quads, built with high quality: a quad per face with the
/// robust flag ("single robust"), and faces merged greedily with and without it ("merged robust",
/// "merged fast"). Of each all four combinations of coherent and incoherent rays and of packets of
/// 8 (4x2 pixels) and 16 (4x4 pixels). Tracing only. Rays must start outside the non-free voxels.
///
/// Only single quads are watertight: where a corner of a merged quad lies on another one's edge,
/// the two edges are rounded apart, and without the robust flag the seam of a quad's two triangles
/// leaks too.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_embree_quads(const TraceTask& task);

}  // namespace viewgain::bench
