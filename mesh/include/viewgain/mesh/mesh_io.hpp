// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "viewgain/core/box.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain {

/// Changes that read_mesh() made to a file's faces.
struct VIEWGAIN_EXPORT MeshRepairs {
  std::size_t mended_faces = 0;   ///< self-crossing faces, split at their crossings
  std::size_t dropped_faces = 0;  ///< faces with three corners or more but no area, omitted
};

/// Reads OFF, OBJ, STL or PLY, chosen by the file name's ending, in the file's unit and axes.
/// Triangulates polygons, also concave and self-crossing ones; omits faces without area and unused
/// vertices; ignores colours, normals and lines. Throws Error(io) if the file cannot be read,
/// Error(format) with file and line if it is malformed or its polygons take too long to
/// triangulate, Error(capacity) if it is too large. Thread safe. Cost: O(file); O(n log n) for a
/// polygon of n corners that is not a fan.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path,
                                                     MeshRepairs* repairs = nullptr);

/// Bounding box of the vertices [m]; zero if there are none. Never throws. Cost: O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT Box bounds_of(const TriangleMesh& mesh);
/// Longest side of a box [m]. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT double longest_side(const Box& box);

/// The axis of the mesh file that points up.
enum class UpAxis : std::uint8_t { x, y, z };

/// Placement of a file's mesh in the world.
struct VIEWGAIN_EXPORT MeshPlacement {
  UpAxis up = UpAxis::z;    ///< axis that becomes +z, by a cyclic permutation of the axes
  bool center = false;      ///< move the bounding box's centre to the origin
  double longest_side = 0;  ///< scale the bounding box's longest side to this [m]; 0: as it is
};

/// Rotates, then scales about the origin, then centres the mesh. Throws Error(invalid_argument) if
/// longest_side is negative or not finite, or the mesh has no extent to scale. Cost: O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh placed(TriangleMesh mesh,
                                                  const MeshPlacement& placement);

/// read_mesh(), then placed(). Errors and cost are those of the two calls; errors name the file.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path,
                                                     const MeshPlacement& placement,
                                                     MeshRepairs* repairs = nullptr);

}  // namespace viewgain
