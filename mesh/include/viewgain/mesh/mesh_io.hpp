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

/// What read_mesh() changed in a file's faces.
struct VIEWGAIN_EXPORT MeshRepairs {
  std::size_t mended_faces = 0;   ///< cross themselves; split where their edges cross
  std::size_t dropped_faces = 0;  ///< have three corners or more and no area; left out
};

/// Reads OFF, OBJ, STL or PLY by the file's ending, in its unit and axes. Polygons, concave or
/// self-crossing, become triangles that fill all that their edges go round; faces without area and
/// unused vertices are left out. Colours, normals and lines are ignored. Throws Error(io) if the
/// file cannot be read, Error(format) with file and line if it is malformed, Error(capacity) as
/// file_bytes(). Thread safe. Costs O(file); O(n log n) for a polygon of n corners that is no fan,
/// up to a limit per file, beyond which it is refused.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path,
                                                     MeshRepairs* repairs = nullptr);

/// The least box with all vertices in it [m]; zero without any. Never throws. Costs O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT Box bounds_of(const TriangleMesh& mesh);
/// The length of a box's longest side [m]. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT double longest_side(const Box& box);

/// Which axis of the mesh file points up.
enum class UpAxis : std::uint8_t { x, y, z };

/// How a file's mesh is placed in the world.
struct VIEWGAIN_EXPORT MeshPlacement {
  UpAxis up = UpAxis::z;  ///< this axis is turned to +z by a cyclic permutation of the axes
  bool center = false;    ///< moves the bounding box's centre to the origin
  double longest_side =
      0;  ///< scales so that the bounding box's longest side is this [m]; 0: as it is
};

/// Applies turn, then scale about the origin, then centring. Throws Error(invalid_argument) if
/// longest_side is negative or not finite, or the mesh has no extent to scale. Costs O(vertices).
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh placed(TriangleMesh mesh,
                                                  const MeshPlacement& placement);

/// Reads a mesh and places it; throws and costs as both, and the errors name the file.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path,
                                                     const MeshPlacement& placement,
                                                     MeshRepairs* repairs = nullptr);

}  // namespace viewgain
