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

/// Makes a mesh of a file's vertices and polygons, in whichever order they come. `line` is where in
/// the file they stand, 0 if it has no lines. Throws Error(format) that begins with `name`.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string name) : name_(std::move(name)) {}

  void add_vertex(const std::array<double, 3>& p, std::size_t line);
  [[nodiscard]] std::size_t vertices() const { return mesh_.vertices.size(); }

  /// Of the face that end_face() ends.
  void add_corner(double index, std::size_t line);
  void end_face(std::size_t line) { faces_.push_back({corners_.size(), line}); }

  /// Triangles that fill the polygons, none of those with fewer than three corners or without area;
  /// vertices that no triangle uses are left out.
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

/// The mesh of a file's bytes; `name` is the file's, for messages. They throw Error(format) that
/// begins with it and, in text, the line.

/// Vertices and faces each on a line of their own, which may go on with colours and normals; or as
/// words, whatever lines they stand on, as the header says and nothing else.
[[nodiscard]] TriangleMesh off_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

/// Of v and f; lines that go on behind a backslash are joined. Free-form surfaces and calls of
/// other files are refused.
[[nodiscard]] TriangleMesh obj_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

/// ASCII, words in any case, or binary; equal points are one vertex.
[[nodiscard]] TriangleMesh stl_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

/// Vertices with x, y, z and lists vertex_indices or vertex_index of faces and strips of triangles,
/// whatever else the file holds.
[[nodiscard]] TriangleMesh ply_mesh(std::string_view bytes, const std::string& name,
                                    MeshRepairs& repairs);

}  // namespace viewgain::detail
