// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "oracle/dense_map.hpp"

namespace viewgain::bench {

/// An axis-aligned rectangle in voxels, relative to the workspace's lowest corner.
struct Quad {
  std::array<std::array<float, 3>, 4> corners;  ///< [0] the lowest, [2] the highest
  bool is_lower_side = false;                   ///< of the voxels: they lie above it along the axis
};

/// The faces perpendicular to each axis by which a ray can enter a non-free voxel from a free one
/// or from the outside, those on the voxels' lower side before those on the upper; the faces of a
/// plane and a side are merged greedily, rows first, then equal rows, into rectangles of at most
/// `most` voxels a side.
[[nodiscard]] std::array<std::vector<Quad>, 3> exposed_quads(const oracle::DenseMap& map, int most);

}  // namespace viewgain::bench
