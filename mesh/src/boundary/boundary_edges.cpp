// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary_edges.hpp"

#include <Eigen/Geometry>
#include <string>

#include "surface/surface_access.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {

std::vector<BoundaryEdge> boundary_edges(const SurfaceMesh& surface,
                                         std::span<const std::uint32_t> vertices,
                                         std::span<const std::uint32_t> triangles, bool closed) {
  if (vertices.size() != triangles.size() + (closed ? 0 : 1)) {
    throw Error(ErrorCode::invalid_argument, "boundary: " + std::to_string(vertices.size()) +
                                                 " vertices do not fit " +
                                                 std::to_string(triangles.size()) + " edges");
  }
  for (const std::uint32_t v : vertices) {
    if (v >= surface.vertices.size()) {
      throw Error(ErrorCode::invalid_argument, "boundary: there is no vertex " + std::to_string(v));
    }
  }
  std::vector<BoundaryEdge> edges(triangles.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (triangles[i] >= surface.triangles.size()) {
      throw Error(ErrorCode::invalid_argument,
                  "boundary: there is no triangle " + std::to_string(triangles[i]));
    }
    const Eigen::Vector3d from = position(surface, vertices[i]);
    const Eigen::Vector3d to = position(surface, vertices[(i + 1) % vertices.size()]);
    const auto& [a, b, c] = surface.triangles[triangles[i]];
    const Eigen::Vector3d corner = position(surface, a);
    BoundaryEdge& edge = edges[i];
    edge.middle = 0.5 * (from + to);
    edge.length = (to - from).norm();
    edge.normal =
        (position(surface, b) - corner).cross(position(surface, c) - corner).stableNormalized();
    edge.outward = (to - from).cross(edge.normal).stableNormalized();
  }
  return edges;
}

}  // namespace viewgain::detail
