// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <string>

#include "boundary_edges.hpp"
#include "surface/surface_access.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/mesh/boundary.hpp"

namespace viewgain::detail {

std::vector<BoundaryEdge> boundary_edges(const SurfaceMesh& surface,
                                         std::span<const std::uint32_t> vertices,
                                         std::span<const std::uint32_t> triangles, bool closed) {
  if (vertices.size() != triangles.size() + (closed ? 0 : 1)) {
    refuse("boundary: one edge per vertex is required; vertices: " +
           std::to_string(vertices.size()) + ", edges: " + std::to_string(triangles.size()));
  }
  for (const std::uint32_t v : vertices) {
    if (v >= surface.vertices.size())
      refuse("boundary: vertex " + std::to_string(v) + " does not exist");
  }
  std::vector<BoundaryEdge> edges(triangles.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (triangles[i] >= surface.triangles.size()) {
      refuse("boundary: triangle " + std::to_string(triangles[i]) + " does not exist");
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

namespace viewgain {
namespace {

// Half-edge 3 f + k goes from corner k of face f to the next corner.
constexpr std::uint32_t kBorder = std::numeric_limits<std::uint32_t>::max();

std::uint32_t next_in_face(std::uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

std::uint32_t start_of(const SurfaceMesh& surface, std::uint32_t half_edge) {
  return surface.triangles[half_edge / 3][half_edge % 3];
}

// The opposite of each half-edge, or kBorder. Edges are sorted by their lower vertex and then by
// the upper vertex.
std::vector<std::uint32_t> opposites(const SurfaceMesh& surface) {
  struct Edge {
    std::uint32_t upper;
    std::uint32_t half_edge;
  };
  const auto count = static_cast<std::uint32_t>(3 * surface.triangles.size());
  const auto ends = [&](std::uint32_t h) {
    return std::minmax({start_of(surface, h), start_of(surface, next_in_face(h))});
  };
  std::vector<std::uint32_t> first(surface.vertices.size() + 1, 0);
  for (std::uint32_t h = 0; h < count; ++h) ++first[ends(h).first + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Edge> edges(count);
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t h = 0; h < count; ++h) {
    const auto [lower, upper] = ends(h);
    edges[next[lower]++] = {upper, h};
  }

  std::vector<std::uint32_t> opposite(count, kBorder);
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    std::sort(edges.begin() + first[v], edges.begin() + first[v + 1],
              [](const Edge& a, const Edge& b) {
                return a.upper != b.upper ? a.upper < b.upper : a.half_edge < b.half_edge;
              });
    for (std::uint32_t i = first[v]; i < first[v + 1];) {
      std::uint32_t end = i + 1;
      while (end < first[v + 1] && edges[end].upper == edges[i].upper) ++end;
      const std::uint32_t a = edges[i].half_edge;
      const std::uint32_t b = edges[end - 1].half_edge;
      if (end - i > 2 || edges[i].upper == v ||
          (a != b && start_of(surface, a) == start_of(surface, b))) {
        refuse("surface: the edge between vertices " + std::to_string(v) + " and " +
               std::to_string(edges[i].upper) +
               " is invalid: it joins a vertex to itself, has more than two faces, or has two "
               "faces of opposite orientation");
      }
      if (a != b) {
        opposite[a] = b;
        opposite[b] = a;
      }
      i = end;
    }
  }
  return opposite;
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const SurfaceMesh& surface) {
  detail::check_surface(surface);
  if (surface.triangles.size() > kBorder / 3) {
    throw Error(ErrorCode::capacity, "surface: " + std::to_string(surface.triangles.size()) +
                                         " triangles are too many; the maximum is " +
                                         std::to_string(kBorder / 3));
  }
  const std::vector<std::uint32_t> opposite = opposites(surface);
  std::vector<bool> taken(opposite.size(), false);
  std::vector<BoundaryLoop> loops;
  for (std::uint32_t start = 0; start < opposite.size(); ++start) {
    if (opposite[start] != kBorder || taken[start]) continue;
    BoundaryLoop& loop = loops.emplace_back();
    std::uint32_t h = start;
    do {
      taken[h] = true;
      loop.vertices.push_back(start_of(surface, h));
      loop.triangles.push_back(h / 3);
      // Follows the faces around the end vertex, to find the border edge of the same fan.
      h = next_in_face(h);
      while (opposite[h] != kBorder) h = next_in_face(opposite[h]);
    } while (h != start);
  }
  return loops;
}

}  // namespace viewgain
