// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "mesh/shapes.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain::test {

inline Eigen::Vector3d vec(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

/// What the mesh is as a surface, counted by other means than the library's.
struct Topology {
  std::size_t edges = 0, border_edges = 0, components = 0, border_loops = 0;
  long euler = 0;
};

/// Connected components of a graph.
inline std::size_t count_classes(
    const std::map<std::uint32_t, std::set<std::uint32_t>>& neighbors) {
  std::set<std::uint32_t> seen;
  std::size_t classes = 0;
  for (const auto& [start, unused] : neighbors) {
    if (!seen.insert(start).second) continue;
    ++classes;
    std::vector<std::uint32_t> open{start};
    while (!open.empty()) {
      const std::uint32_t v = open.back();
      open.pop_back();
      for (const std::uint32_t w : neighbors.at(v)) {
        if (seen.insert(w).second) open.push_back(w);
      }
    }
  }
  return classes;
}

/// Checks what every surface must satisfy and returns its topology.
inline Topology check_surface(const SurfaceMesh& mesh, const std::vector<OrientedPoint>& points,
                              const SurfaceConfig& config) {
  EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
  EXPECT_EQ(mesh.source.size(), mesh.vertices.size());
  std::set<std::uint32_t> sources;
  const auto spacing_of = [&](std::uint32_t vertex) {
    return std::max(config.spacing, points[mesh.source[vertex]].spacing);
  };
  for (std::size_t v = 0; v < mesh.source.size(); ++v) {
    const std::uint32_t source = mesh.source[v];
    if (source >= points.size()) {
      ADD_FAILURE() << "source " << source;
      return {};
    }
    EXPECT_TRUE(sources.insert(source).second) << "a point became two vertices";
    const double moved = (vec(mesh.vertices[v]) - vec(points[source].position)).norm();
    EXPECT_LE(moved, 1.25 * spacing_of(static_cast<std::uint32_t>(v)) * (1 + 1e-9));
    EXPECT_NEAR(norm(mesh.normals[v]), 1, 1e-9);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::map<std::uint32_t, std::set<std::uint32_t>> neighbors, border;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a >= mesh.vertices.size()) {
        ADD_FAILURE() << "vertex " << a;
        return {};
      }
      EXPECT_NE(a, b);
      EXPECT_EQ(++directed[std::pair(a, b)], 1) << "two faces have an edge in one direction";
      neighbors[a].insert(b);
      neighbors[b].insert(a);
      const double length = (vec(mesh.vertices[a]) - vec(mesh.vertices[b])).norm();
      EXPECT_LE(length, (config.max_edge + 1e-3) * std::max(spacing_of(a), spacing_of(b)));
    }
  }
  EXPECT_EQ(neighbors.size(), mesh.vertices.size()) << "a vertex is in no face";
  Topology topology;
  for (const auto& [edge, unused] : directed) {
    const bool interior = directed.contains(std::pair(edge.second, edge.first));
    if (!interior) {
      ++topology.border_edges;
      border[edge.first].insert(edge.second);
      border[edge.second].insert(edge.first);
    }
    if (!interior || edge.first < edge.second) ++topology.edges;
  }
  topology.components = count_classes(neighbors);
  topology.border_loops = count_classes(border);
  topology.euler = static_cast<long>(mesh.vertices.size() + mesh.triangles.size()) -
                   static_cast<long>(topology.edges);
  return topology;
}

inline double area_of(const SurfaceMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = vec(mesh.vertices[t[0]]);
    area += 0.5 * (vec(mesh.vertices[t[1]]) - a).cross(vec(mesh.vertices[t[2]]) - a).norm();
  }
  return area;
}

/// Share of vertices whose normal is within 15° of the one its point's hint gives.
inline double good_normals(const SurfaceMesh& mesh, const std::vector<OrientedPoint>& points) {
  std::size_t good = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d hint = vec(points[mesh.source[v]].toward_free).normalized();
    if (hint.dot(vec(mesh.normals[v])) > std::cos(15 * std::numbers::pi / 180)) ++good;
  }
  return static_cast<double>(good) / static_cast<double>(mesh.vertices.size());
}

}  // namespace viewgain::test
