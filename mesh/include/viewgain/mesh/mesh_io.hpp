// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "viewgain/core/box.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain {

/// Reads OFF, OBJ, STL or PLY (the last two in text and binary), chosen by the file name's ending,
/// in the file's own unit and axes. Polygons are split into triangles that fill them, concave ones
/// too; vertices that no face uses and faces of fewer than three corners are left out; which side
/// of a face is outside is not changed. Colours, normals and lines are not looked at. Throws
/// Error(io) if the file cannot be read and Error(format), naming the file and, in text, the line,
/// if it cannot be parsed, has no faces, a coordinate that is not finite, an index out of range, a
/// polygon that crosses itself, or more or fewer rows than it says; Error(capacity) as
/// file_bytes(). Thread safe. Costs O(file), and for polygons that are no fan the squares of their
/// corners, of which they may have 10,000.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh read_mesh(const std::filesystem::path& path);

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
                                                     const MeshPlacement& placement);

}  // namespace viewgain
