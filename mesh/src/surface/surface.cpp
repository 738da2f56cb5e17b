// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/surface.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "advancing_front.hpp"
#include "keyed_sort.hpp"
#include "point_cleaning.hpp"
#include "surface_access.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

void check_surface(const SurfaceMesh& surface) {
  const std::size_t count = surface.vertices.size();
  if (surface.normals.size() != count) {
    refuse("surface: one normal per vertex is required; vertices: " + std::to_string(count) +
           ", normals: " + std::to_string(surface.normals.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!vector(surface.vertices[i]).allFinite() || !vector(surface.normals[i]).allFinite()) {
      refuse("surface: vertex " + std::to_string(i) + " is not finite");
    }
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const std::uint32_t v : surface.triangles[i]) {
      if (v >= count) {
        refuse("surface: triangle " + std::to_string(i) + " refers to vertex " + std::to_string(v) +
               "; it must be less than the number of vertices, " + std::to_string(count));
      }
    }
  }
}

// Components of faces that are connected across edges.
struct FaceComponents {
  std::vector<std::uint32_t> of_face;  ///< numbered from 0 in the order of their first faces
  std::size_t count = 0;
};

namespace {

using Triangle = std::array<std::uint32_t, 3>;

// The directed edge from corner k.
std::uint64_t edge_of(const Triangle& t, std::size_t k) { return key_of(t[k], t[(k + 1) % 3]); }

std::uint64_t reversed(std::uint64_t edge) { return edge << 32U | edge >> 32U; }

}  // namespace

// Omits triangles that repeat a vertex or would give an edge a third face or a second face in the
// same direction. Earlier triangles are kept.
void drop_non_manifold(std::vector<Triangle>& triangles) {
  // If each directed edge is in at most one face, an edge has at most two faces, in opposite
  // directions.
  std::vector<Keyed> edges;
  edges.reserve(3 * triangles.size());
  std::vector<bool> at_fault(triangles.size(), false);
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    at_fault[f] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(edge_of(t, k), f);
  }
  sort_by_key(edges);
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].first == edges[e - 1].first) at_fault[edges[e].second] = true;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (!at_fault[f]) triangles[kept++] = triangles[f];
  }
  triangles.resize(kept);
}

FaceComponents face_components(const std::vector<Triangle>& triangles) {
  std::vector<Keyed> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t edge = edge_of(triangles[f], k);
      edges.emplace_back(std::min(edge, reversed(edge)), f);
    }
  }
  sort_by_key(edges);

  std::vector<std::uint32_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root_of = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].first != edges[e - 1].first) continue;
    const std::uint32_t a = root_of(edges[e].second), b = root_of(edges[e - 1].second);
    parent[std::max(a, b)] = std::min(a, b);
  }
  // The root of a component is its first face.
  FaceComponents components{std::vector<std::uint32_t>(triangles.size()), 0};
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const std::uint32_t root = root_of(f);
    components.of_face[f] =
        root == f ? static_cast<std::uint32_t>(components.count++) : components.of_face[root];
  }
  return components;
}

// Omits components of fewer than min_vertices vertices.
void drop_small(std::vector<Triangle>& triangles, FaceComponents& components,
                std::size_t min_vertices) {
  std::vector<Keyed> members;  // component by vertex
  members.reserve(3 * triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (const std::uint32_t v : triangles[f]) {
      members.emplace_back(key_of(v, components.of_face[f]), components.of_face[f]);
    }
  }
  sort_by_key(members);
  members.erase(std::unique(members.begin(), members.end()), members.end());
  std::vector<std::size_t> vertices(components.count, 0);
  for (const auto& [key, component] : members) ++vertices[component];

  constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(components.count, kDropped);
  std::size_t count = 0;
  for (std::size_t c = 0; c < components.count; ++c) {
    if (vertices[c] >= min_vertices) renumbered[c] = static_cast<std::uint32_t>(count++);
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::uint32_t component = renumbered[components.of_face[f]];
    if (component == kDropped) continue;
    triangles[kept] = triangles[f];
    components.of_face[kept++] = component;
  }
  triangles.resize(kept);
  components.of_face.resize(kept);
  components.count = count;
}

}  // namespace viewgain::detail

namespace viewgain {
namespace {

using detail::Point3;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kDuplicate = 0.05;  // nearer points are merged [spacings]
constexpr double kMinArea = 1e-6;  // smallest double area of a triangle with a normal [spacings²]
constexpr double kMinDistance = 0.25;  // of vertices after smoothing [spacings]

void check(std::span<const OrientedPoint> points, const SurfaceConfig& config) {
  const auto refuse = [](const std::string& what, double value) {
    viewgain::refuse(what + ", not " + short_text(value));
  };
  if (!std::isfinite(config.spacing) || config.spacing <= 0) {
    refuse("the spacing must be positive and finite", config.spacing);
  }
  if (!std::isfinite(config.max_edge) || config.max_edge <= 0) {
    refuse("the longest edge must be positive and finite", config.max_edge);
  }
  if (!std::isfinite(config.join_distance) || config.join_distance <= 0) {
    refuse("the join distance must be positive and finite", config.join_distance);
  }
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::capacity, "there are 2^32 points or more; the maximum is 2^32 - 1");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double x : points[i].position) {
      if (!std::isfinite(x)) {
        viewgain::refuse("a coordinate of point " + std::to_string(i) + " is not finite");
      }
    }
    const double spacing = points[i].spacing;
    if (spacing != 0 && !(spacing >= config.spacing && std::isfinite(spacing))) {
      refuse("the spacing at point " + std::to_string(i) + " must be finite and at least " +
                 short_text(config.spacing),
             spacing);
    }
  }
}

// The current points; `index` has their indices in the input.
struct Selection {
  std::vector<std::uint32_t> index;
  std::vector<OrientedPoint> points;

  void keep(std::span<const std::uint32_t> kept) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      index[k] = index[kept[k]];
      points[k] = points[kept[k]];
    }
    index.resize(kept.size());
    points.resize(kept.size());
  }
};

Eigen::Vector3d vector_of(const Point3& p) { return {p[0], p[1], p[2]}; }

// Positions relative to the first point, in units of the spacing. Offsets of a ten-thousandth avoid
// ties: for points on a lattice CGAL would choose by memory addresses.
std::vector<Point3> triangulation_points(std::span<const OrientedPoint> points, double spacing) {
  std::vector<Point3> scaled(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double offset = unit_number(mix64((3 * i + k) * kMixStep));
      scaled[i][k] =
          (points[i].position[k] - points[0].position[k]) / spacing + 1e-4 * (offset - 0.5);
    }
  }
  return scaled;
}

Eigen::Vector3d area_vector(std::span<const OrientedPoint> points, const Triangle& t) {
  const Eigen::Vector3d a = vector_of(points[t[0]].position);
  return (vector_of(points[t[1]].position) - a).cross(vector_of(points[t[2]].position) - a);
}

// Flips components whose faces point away from free space according to the hints of their corners.
// A hint is weighted by its cosine to the face's normal. Without hints, the first face's vertices
// are in ascending order.
void orient(std::vector<Triangle>& triangles, const detail::FaceComponents& components,
            std::span<const OrientedPoint> points) {
  std::vector<double> vote(components.count, 0.0);
  std::vector<bool> falls(components.count, false);  // order of the first face's vertices
  for (std::size_t f = triangles.size(); f-- > 0;) {
    const Triangle& t = triangles[f];
    const Eigen::Vector3d normal = area_vector(points, t).stableNormalized();
    const std::uint32_t c = components.of_face[f];
    for (const std::uint32_t v : t) {
      vote[c] += normal.dot(vector_of(points[v].toward_free).stableNormalized());
    }
    falls[c] = t[1] > t[2];
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::uint32_t c = components.of_face[f];
    if (vote[c] < 0 || (vote[c] == 0 && falls[c])) std::swap(triangles[f][1], triangles[f][2]);
  }
}

SurfaceMesh assemble(const Selection& selection, const std::vector<Triangle>& triangles) {
  SurfaceMesh mesh;
  std::vector<Eigen::Vector3d> normals(selection.points.size(), Eigen::Vector3d::Zero());
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d area = area_vector(selection.points, t);
    for (const std::uint32_t v : t) normals[v] += area;
  }
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertex_of(selection.points.size(), kUnused);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) vertex_of[v] = 0;
  }
  for (std::size_t v = 0; v < vertex_of.size(); ++v) {
    if (vertex_of[v] == kUnused) continue;
    vertex_of[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(selection.points[v].position);
    mesh.source.push_back(selection.index[v]);
    const Eigen::Vector3d n = normals[v].stableNormalized();
    mesh.normals.push_back({n.x(), n.y(), n.z()});
  }
  for (const Triangle& t : triangles) {
    mesh.triangles.push_back({vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]});
  }
  return mesh;
}

}  // namespace

SurfaceMesh reconstruct_surface(std::span<const OrientedPoint> points, const SurfaceConfig& config,
                                const ExecConfig& exec) {
  check(points, config);
  Selection selection{std::vector<std::uint32_t>(points.size()), {points.begin(), points.end()}};
  for (std::uint32_t i = 0; i < points.size(); ++i) selection.index[i] = i;
  const auto keep_apart = [&](std::span<const Point3> positions, double distance) {
    selection.keep(detail::apart(positions, distance * config.spacing));
  };
  keep_apart(detail::positions_of(selection.points), kDuplicate);
  selection.keep(detail::large_components(selection.points, config));
  if (selection.points.size() < 3) return {};

  const std::vector<Point3> positions = detail::smoothed(selection.points, config, exec);
  for (std::size_t i = 0; i < positions.size(); ++i) selection.points[i].position = positions[i];
  keep_apart(positions, kMinDistance);
  if (selection.points.size() < 3) return {};

  std::vector<double> max_edge;
  for (const OrientedPoint& p : selection.points) {
    max_edge.push_back(config.max_edge * (detail::spacing_at(p, config) / config.spacing));
  }
  std::vector<Triangle> triangles = detail::advancing_front(
      triangulation_points(selection.points, config.spacing), max_edge, exec);
  std::erase_if(triangles, [&](const Triangle& t) {
    return area_vector(selection.points, t).norm() < kMinArea * config.spacing * config.spacing;
  });
  detail::drop_non_manifold(triangles);
  detail::FaceComponents components = detail::face_components(triangles);
  detail::drop_small(triangles, components, config.min_component);
  orient(triangles, components, selection.points);
  return assemble(selection, triangles);
}

}  // namespace viewgain
