// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Triangle mesh as plain arrays, in any frame. Triangles need not be connected. Functions that
/// take a mesh check its indices.
struct VIEWGAIN_EXPORT TriangleMesh {
  std::vector<std::array<double, 3>> vertices;          ///< [m], or in the unit of the file
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three vertex indices each
};

/// The faces of a box, as two outward triangles each. The indices are those of the box's corners.
/// Corner i is at max.x if bit 0 of i is set, at max.y if bit 1 is set, and at max.z if bit 2 is
/// set; otherwise it is at the minimum.
inline constexpr std::array<std::array<std::uint32_t, 3>, 12> kBoxTriangles{{{0, 2, 1},
                                                                             {1, 2, 3},
                                                                             {4, 5, 6},
                                                                             {5, 7, 6},
                                                                             {0, 1, 4},
                                                                             {1, 5, 4},
                                                                             {2, 6, 3},
                                                                             {3, 6, 7},
                                                                             {0, 4, 2},
                                                                             {2, 4, 6},
                                                                             {1, 3, 5},
                                                                             {3, 7, 5}}};

}  // namespace viewgain
