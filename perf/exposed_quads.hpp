// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "oracle/dense_map.hpp"

namespace viewgain::bench {

/// An axis-aligned rectangle in voxels, relative to the workspace's lowest corner.
struct Quad {
  std::array<std::array<float, 3>, 4> corners;
};

/// The faces between non-free voxels and free ones (or the outside), perpendicular to `axis` and
/// merged greedily: rows first, then equal rows. Both sides of the voxels; overlapping faces of the
/// two sides do not exist, since a face is exposed on one side only.
[[nodiscard]] std::vector<Quad> exposed_quads(const oracle::DenseMap& map, int axis);

}  // namespace viewgain::bench
