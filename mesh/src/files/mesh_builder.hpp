// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::detail {

/// Makes a mesh of a file's vertices and polygons, in whichever order they come. Throws
/// Error(format) that begins with `name`.
class MeshBuilder {
 public:
  /// `vertex_count`: as many as add_vertex() will be called for.
  MeshBuilder(std::string name, std::size_t vertex_count)
      : name_(std::move(name)), vertex_count_(vertex_count) {
    if (vertex_count > std::numeric_limits<std::uint32_t>::max()) fail("more than 2^32 vertices");
  }

  void add_vertex(const std::array<double, 3>& p) {
    for (const double x : p) {
      if (std::isfinite(x)) continue;
      fail("a coordinate of vertex " + std::to_string(mesh_.vertices.size()) + " is not finite");
    }
    mesh_.vertices.push_back(p);
  }

  /// A fan of triangles; none of a face with fewer than three corners. The indices may be numbers
  /// of any type.
  template <typename Corners>
  void add_face(const Corners& corners) {
    for (const auto index : corners) {
      if (static_cast<double>(index) >= 0 && static_cast<double>(index) < limit_) continue;
      fail("face " + std::to_string(faces_) + " has an index out of range, the file has " +
           std::to_string(vertex_count_) + " vertices");
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      mesh_.triangles.push_back({static_cast<std::uint32_t>(corners[0]),
                                 static_cast<std::uint32_t>(corners[i - 1]),
                                 static_cast<std::uint32_t>(corners[i])});
    }
    ++faces_;
  }

  [[nodiscard]] TriangleMesh finish() && {
    if (mesh_.triangles.empty()) fail("the mesh has no faces");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, name_ + ": " + what);
  }

  std::string name_;
  std::size_t vertex_count_;
  double limit_ = static_cast<double>(vertex_count_);
  std::size_t faces_ = 0;
  TriangleMesh mesh_;
};

}  // namespace viewgain::detail
