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

/// Numbers of faces that read_mesh() repaired or omitted.
struct VIEWGAIN_EXPORT MeshRepairs {
  std::size_t mended_faces = 0;   ///< self-crossing faces, split at their crossings
  std::size_t dropped_faces = 0;  ///< omitted faces, with three or more corners but no area
};

/// Reads an OFF, OBJ, STL or PLY file, according to the ending of its name. Keeps the unit and axes
/// of the file. Triangulates polygons, including concave and self-crossing ones. Omits faces
/// without area, unused vertices, colours, normals and lines. Throws Error(io) if the file cannot
/// be read, and Error(capacity) if it is too large. Throws Error(format) with file and line if it
/// is malformed or its polygons take too long to triangulate. Sets *repairs, if not null. Thread
/// safe. Cost: linear in the file, and O(n log n) for a polygon of n corners that is not a fan.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path,
                                                     MeshRepairs* repairs = nullptr);

/// Bounding box of the vertices [m]; all zeros if there are none. Never throws. Cost: O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT Box bounds_of(const TriangleMesh& mesh);
/// Longest side of a box [m]. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT double longest_side(const Box& box);

/// The axis of the mesh file that points up.
enum class UpAxis : std::uint8_t { x, y, z };

/// How to place the mesh of a file in the world.
struct VIEWGAIN_EXPORT MeshPlacement {
  UpAxis up = UpAxis::z;    ///< axis of the file that becomes +z, by a cyclic permutation
  bool center = false;      ///< whether to move the centre of the bounding box to the origin
  double longest_side = 0;  ///< length of the longest side after scaling [m]; 0: do not scale
};

/// The mesh after it is rotated, then scaled about the origin, then centred. Throws
/// Error(invalid_argument) if longest_side is negative or not finite, or a mesh to scale has no
/// extent. Cost: O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh placed(TriangleMesh mesh,
                                                  const MeshPlacement& placement);

/// Calls read_mesh(), then placed(). Throws and costs what the two calls do; errors name the file.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path,
                                                     const MeshPlacement& placement,
                                                     MeshRepairs* repairs = nullptr);

}  // namespace viewgain
