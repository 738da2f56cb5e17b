// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace viewgain::detail {

/// Faces that are connected across edges.
struct FaceComponents {
  std::vector<std::uint32_t> of_face;  ///< numbered from 0 in the order of their first faces
  std::size_t count = 0;
};

/// Leaves out every triangle that would give an edge a third face, or a second in the same
/// direction, or that repeats a vertex; of the triangles at fault the earlier ones stay.
void drop_non_manifold(std::vector<std::array<std::uint32_t, 3>>& triangles);

[[nodiscard]] FaceComponents face_components(
    const std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Leaves out components of fewer than min_vertices vertices.
void drop_small(std::vector<std::array<std::uint32_t, 3>>& triangles, FaceComponents& components,
                std::size_t min_vertices);

}  // namespace viewgain::detail
