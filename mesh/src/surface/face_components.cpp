// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "face_components.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace viewgain::detail {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// The directed edge from corner k.
std::uint64_t edge_of(const Triangle& t, std::size_t k) {
  return static_cast<std::uint64_t>(t[k]) << 32U | t[(k + 1) % 3];
}

std::uint64_t reversed(std::uint64_t edge) { return edge << 32U | edge >> 32U; }

}  // namespace

void drop_non_manifold(std::vector<Triangle>& triangles) {
  // With each directed edge in one face at most, an edge has at most two, in opposite directions.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;
  edges.reserve(3 * triangles.size());
  std::vector<bool> at_fault(triangles.size(), false);
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    at_fault[f] = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(edge_of(t, k), f);
  }
  std::sort(edges.begin(), edges.end());
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
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t edge = edge_of(triangles[f], k);
      edges.emplace_back(std::min(edge, reversed(edge)), f);
    }
  }
  std::sort(edges.begin(), edges.end());

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

void drop_small(std::vector<Triangle>& triangles, FaceComponents& components,
                std::size_t min_vertices) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // component, vertex
  members.reserve(3 * triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (const std::uint32_t v : triangles[f]) members.emplace_back(components.of_face[f], v);
  }
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  std::vector<std::size_t> vertices(components.count, 0);
  for (const auto& [component, vertex] : members) ++vertices[component];

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
