// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/mesh/mesh_io.hpp"

namespace viewgain::detail {

/// Makes a mesh from a file's vertices and polygons, in any order. `line` is their line in the
/// file, 0 if it has no lines. Throws Error(format) that begins with `name`.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string name) : name_(std::move(name)) {}

  void add_vertex(const std::array<double, 3>& p, std::size_t line);
  [[nodiscard]] std::size_t vertices() const { return mesh_.vertices.size(); }

  /// Adds a corner to the face that end_face() completes.
  void add_corner(double index, std::size_t line);
  void end_face(std::size_t line) { faces_.push_back({corners_.size(), line}); }

  /// Triangles that fill the polygons. Omits polygons with fewer than three corners or without
  /// area, and unused vertices.
  [[nodiscard]] TriangleMesh finish(MeshRepairs& repairs) &&;

 private:
  struct Face {
    std::size_t end;  ///< in corners_
    std::size_t line;
  };

  [[noreturn]] void fail(std::size_t line, const std::string& what) const;
  void split_faces();
  void drop_unused();

  std::string name_;
  std::vector<std::uint32_t> corners_;
  std::vector<Face> faces_;
  TriangleMesh mesh_;
  MeshRepairs repairs_;
};

/// Readers of mesh files from their bytes. `name` is the file's name in messages. They throw
/// Error(format) that begins with the name and, for text, the line.

/// Reads vertices and faces with one line each, which may continue with colours and normals.
/// Otherwise reads exactly the words that the header announces, on any lines.
[[nodiscard]] TriangleMesh off_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

/// Reads v and f; lines that end in a backslash are continued. Free-form surfaces and calls of
/// other files are refused.
[[nodiscard]] TriangleMesh obj_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

/// ASCII with words in any case, or binary. Equal points become one vertex.
[[nodiscard]] TriangleMesh stl_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

/// Reads vertices with x, y, z, and faces and triangle strips with lists vertex_indices or
/// vertex_index. Ignores other contents.
[[nodiscard]] TriangleMesh ply_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

}  // namespace viewgain::detail
