// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "trace_method.hpp"

namespace viewgain::bench {

/// Embree over the exposed faces of the map as quads, with a high-quality BVH. Tracing only. Rays
/// must start outside the non-free voxels. The variants:
/// - "single robust": one quad per face, robust flag
/// - "merged robust", "merged fast": greedily merged faces, with and without the robust flag
///
/// Each comes in four combinations: coherent or incoherent rays, packets of 8 (4x2 pixels) or 16
/// (4x4 pixels).
///
/// Only single quads are watertight. If a corner of a merged quad lies on the edge of another quad,
/// rounding separates the two edges. Without the robust flag, the seam between a quad's two
/// triangles leaks too.
[[nodiscard]] std::vector<std::unique_ptr<TraceMethod>> make_embree_quads(const TraceTask& task);

}  // namespace viewgain::bench
