// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "advancing_front.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "front_growth.hpp"
#include "front_triangulation.hpp"
#include "keyed_sort.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {
namespace {

using namespace front;

using Triangle = std::array<std::uint32_t, 3>;

// The facets that may become triangles, in CGAL's order. Computes all radii, each from the side
// from which CGAL would compute it first, because rounding depends on the side.
std::vector<Facet> possible_triangles(const Front& growing, const BoundedEdges& priority,
                                      const ExecConfig& exec) {
  const Triangulation& triangulation = growing.triangulation_3();
  std::vector<Delaunay::Cell_handle> cells;
  cells.reserve(triangulation.number_of_cells());
  for (const auto cell : triangulation.all_cell_handles()) cells.push_back(cell);

  constexpr std::size_t kChunk = 4096;
  std::vector<std::vector<Facet>> parts(cells.size() / kChunk + 1);
  ThreadPool pool(exec.num_threads);
  pool.for_each_chunk(cells.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Facet>& part = parts[begin / kChunk];
    for (std::size_t c = begin; c < end; ++c) {
      for (int i = 0; i < 4; ++i) {
        // The neighbour handles this facet, or the facet is infinite.
        if (cells[c]->neighbor(i) < cells[c] || triangulation.is_infinite(cells[c], i)) continue;
        if (priority(growing, cells[c], i) < growing.infinity()) part.emplace_back(cells[c], i);
      }
    }
  });
  std::vector<Facet> facets;
  for (const auto& part : parts) facets.insert(facets.end(), part.begin(), part.end());
  return facets;
}

std::vector<Triangle> selected_triangles(const Triangulation& triangulation) {
  std::vector<Triangle> triangles;
  for (const auto cell : triangulation.all_cell_handles()) {
    for (int i = 0; i < 4; ++i) {
      if (!cell->is_selected_facet(i)) continue;
      const auto corner = [&](int k) {
        return static_cast<std::uint32_t>(cell->vertex((i + k) & 3)->id());
      };
      triangles.push_back({corner(1), corner(2), corner(3)});
    }
  }
  return triangles;
}

// Flips triangles so that neighbours have consistent orientations.
void orient_alike(std::vector<Triangle>& triangles) {
  std::vector<Keyed> edges;  // values: 3 * triangle + opposite corner
  edges.reserve(3 * triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[f][(k + 1) % 3], triangles[f][(k + 2) % 3]);
      edges.emplace_back(key_of(low, high), 3 * f + k);
    }
  }
  sort_by_key(edges);
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> beyond(edges.size(),
                                    kNone);  // index of the same edge in the other triangle
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].first != edges[e - 1].first) continue;
    beyond[edges[e].second] = edges[e - 1].second;
    beyond[edges[e - 1].second] = edges[e].second;
  }

  const auto rises = [&](std::uint32_t edge) {
    const Triangle& t = triangles[edge / 3];
    return t[(edge + 1) % 3] < t[(edge + 2) % 3];
  };
  // Not of one byte, because GCC 14 then warns falsely of what it frees.
  enum class Side { unknown, as_is, turned };
  std::vector<Side> sides(triangles.size(), Side::unknown);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (sides[first] != Side::unknown) continue;
    sides[first] = Side::as_is;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t f = open.back();
      open.pop_back();
      for (std::uint32_t edge = 3 * f; edge < 3 * f + 3; ++edge) {
        const std::uint32_t back = beyond[edge];
        if (back == kNone || sides[back / 3] != Side::unknown) continue;
        const bool is_turned = (sides[f] == Side::turned) != (rises(edge) == rises(back));
        sides[back / 3] = is_turned ? Side::turned : Side::as_is;
        open.push_back(back / 3);
      }
    }
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    if (sides[f] == Side::turned) std::swap(triangles[f][1], triangles[f][2]);
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> advancing_front(std::span<const Point3> points,
                                                          std::span<const double> max_edge,
                                                          const ExecConfig& exec) {
  std::vector<std::pair<Kernel::Point_3, std::size_t>> input;
  input.reserve(points.size());
  for (const Point3& p : points)
    input.emplace_back(Kernel::Point_3(p[0], p[1], p[2]), input.size());
  Triangulation triangulation(input.begin(), input.end());
  const BoundedEdges priority{max_edge};
  Front growing(triangulation, priority);
  if (triangulation.dimension() < 3) return {};
  triangulation.set_seeds(possible_triangles(growing, priority, exec));
  FrontGrowth(growing, priority).run();
  std::vector<Triangle> triangles = selected_triangles(triangulation);
  orient_alike(triangles);
  for (Triangle& t : triangles) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  }
  // The orientation of a component is arbitrary, so the order must not depend on it.
  const auto key = [](const Triangle& t) {
    return std::array{t[0], std::min(t[1], t[2]), std::max(t[1], t[2])};
  };
  std::sort(triangles.begin(), triangles.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return triangles;
}

}  // namespace viewgain::detail
