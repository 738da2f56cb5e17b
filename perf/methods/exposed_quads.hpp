// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "oracle/dense_map.hpp"

namespace viewgain::bench {

/// An axis-aligned rectangle [voxel], relative to the lowest corner of the workspace.
struct Quad {
  std::array<std::array<float, 3>, 4> corners;  ///< [0] the lowest, [2] the highest
  bool is_lower_side = false;  ///< is it the lower side of its voxels along the axis?
};

/// The faces by which a ray can enter a non-free voxel from a free one or from outside, by axis.
/// Faces on the lower side of voxels come before those on the upper side. The faces of a plane and
/// side are merged greedily, first along rows, then over equal rows, into rectangles of at most
/// `most` voxels per side.
[[nodiscard]] std::array<std::vector<Quad>, 3> exposed_quads(const oracle::DenseMap& map, int most);

}  // namespace viewgain::bench
