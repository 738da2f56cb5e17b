// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::detail {

/// The mesh of a file's bytes; `name` is the file's, for messages. They throw Error(format) that
/// begins with it and, in text, the line.

/// Vertices and faces each on a line of their own, which may go on with colours and normals; or as
/// words, whatever lines they stand on, as the header says and nothing else.
[[nodiscard]] TriangleMesh off_mesh(std::string_view bytes, const std::string& name);

/// Of v and f; lines that go on behind a backslash are joined. Free-form surfaces and calls of
/// other files are refused.
[[nodiscard]] TriangleMesh obj_mesh(std::string_view bytes, const std::string& name);

/// ASCII, words in any case, or binary; equal points are one vertex.
[[nodiscard]] TriangleMesh stl_mesh(std::string_view bytes, const std::string& name);

/// Vertices with x, y, z and lists vertex_indices or vertex_index of faces and strips of triangles,
/// whatever else the file holds.
[[nodiscard]] TriangleMesh ply_mesh(std::string_view bytes, const std::string& name);

}  // namespace viewgain::detail
