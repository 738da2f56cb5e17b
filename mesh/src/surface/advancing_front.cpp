// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// CGAL's assertions print before they throw.
#define CGAL_NDEBUG 1

#include "advancing_front.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Advancing_front_surface_reconstruction_cell_base_3.h>
#include <CGAL/Advancing_front_surface_reconstruction_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_3.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "keyed_sort.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// CGAL compares handles to vertices and cells by address. The side from which it sees a triangle,
// and the rounding of its radius, would then depend on memory addresses. Elements with a time stamp
// are compared by the time stamp instead.
template <typename Base>
class Stamped : public Base {
 public:
  using Base::Base;
  template <typename Triangulation>
  struct Rebind_TDS {
    using Other = Stamped<typename Base::template Rebind_TDS<Triangulation>::Other>;
  };

  // CGAL's names.
  using Has_timestamp = CGAL::Tag_true;
  [[nodiscard]] std::size_t time_stamp() const { return stamp_; }
  void set_time_stamp(std::size_t stamp) { stamp_ = stamp; }

 private:
  std::size_t stamp_ = static_cast<std::size_t>(-1);  // CGAL's value for "not yet"
};

// The same for the border's edges. CGAL sorts them by priority, and by address if priorities are
// equal, as for edges with the same best triangle.
template <typename Base>
class OrderedBorder : public Base {
 public:
  using Base::Base;
  template <typename Triangulation>
  struct Rebind_TDS {
    using Other = OrderedBorder<typename Base::template Rebind_TDS<Triangulation>::Other>;
  };

  // Replaces the base's pair of the same name.
  struct Radius_ptr_type {
    typename Base::criteria first;
    typename Base::IO_edge_type* second;
    std::size_t from, to;

    Radius_ptr_type(typename Base::criteria priority, typename Base::IO_edge_type* edge)
        : first(priority), second(edge) {
      const auto& side = edge->first.first;
      from = side.first->vertex(side.second)->id();
      to = side.first->vertex(side.third)->id();
    }
    bool operator<(const Radius_ptr_type& other) const {
      return std::tie(first, from, to, second) <
             std::tie(other.first, other.from, other.to, other.second);
    }
  };
};

// Keeps the radii of a cell's four facets inside the cell, so that threads can set them. CGAL's own
// cell allocates them when the first is known.
template <typename Base>
class WithRadii : public Base {
 public:
  using Base::Base;
  template <typename Triangulation>
  struct Rebind_TDS {
    using Other = WithRadii<typename Base::template Rebind_TDS<Triangulation>::Other>;
  };

  // CGAL's names.
  [[nodiscard]] double smallest_radius(int facet) const {
    return radii_[static_cast<std::size_t>(facet)];
  }
  void set_smallest_radius(int facet, double radius) {
    radii_[static_cast<std::size_t>(facet)] = radius;
  }
  void clear() {
    Base::clear();
    radii_.fill(-1);
  }

 private:
  std::array<double, 4> radii_{-1, -1, -1, -1};  // CGAL's value for "not yet"
};

using Vertex =
    OrderedBorder<Stamped<CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>>;
using Cell = Stamped<WithRadii<CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>>>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Facet = Delaunay::Facet;
using Triangle = std::array<std::uint32_t, 3>;

// To start a component, CGAL scans all facets for the best one whose vertices belong to no
// component yet. This class lets CGAL scan only the facets that can still be chosen.
class Triangulation : public Delaunay {
 public:
  using Delaunay::Delaunay;
  using Finite_facets_iterator = std::vector<Facet>::const_iterator;

  void set_seeds(std::vector<Facet> seeds) { seeds_ = std::move(seeds); }

  [[nodiscard]] Finite_facets_iterator finite_facets_begin() const { return seeds_.begin(); }
  [[nodiscard]] Finite_facets_iterator finite_facets_end() {
    std::erase_if(seeds_, [](const Facet& facet) {
      const auto is_taken = [&](int corner) {
        return !facet.first->vertex((facet.second + corner) & 3)->is_exterior();
      };
      return is_taken(1) || is_taken(2) || is_taken(3);
    });
    return seeds_.end();
  }
  void remove(Delaunay::Vertex_handle vertex) {
    Delaunay::remove(vertex);
    seeds_.assign(Delaunay::finite_facets_begin(), Delaunay::finite_facets_end());
  }

 private:
  std::vector<Facet> seeds_;
};

// CGAL's own priority, the radius of the smallest empty sphere, but infinite for long edges, so
// that these are never used.
struct BoundedEdges {
  std::span<const double> max_edge;  // by the vertices' id

  template <typename AdvancingFront, typename CellHandle>
  double operator()(const AdvancingFront& front, CellHandle& cell, const int& index) const {
    const double known = cell->smallest_radius(index);
    if (known >= 0) return known;
    const auto& a = *cell->vertex((index + 1) & 3);
    const auto& b = *cell->vertex((index + 2) & 3);
    const auto& c = *cell->vertex((index + 3) & 3);
    const auto is_long = [&](const auto& from, const auto& to) {
      const double most = std::max(max_edge[from.id()], max_edge[to.id()]);
      return CGAL::squared_distance(from.point(), to.point()) > most * most;
    };
    if (!is_long(a, b) && !is_long(b, c) && !is_long(c, a)) {
      return front.smallest_radius_delaunay_sphere(cell, index);
    }
    const auto beyond = cell->neighbor(index);
    cell->set_smallest_radius(index, front.infinity());
    beyond->set_smallest_radius(beyond->index(cell), front.infinity());
    return front.infinity();
  }
};

using Front = CGAL::Advancing_front_surface_reconstruction<Triangulation, BoundedEdges>;

// The facets that may become triangles, in CGAL's order. Computes all radii, each from the side
// from which CGAL would compute it first, because rounding depends on the side.
std::vector<Facet> possible_triangles(const Front& front, const BoundedEdges& priority,
                                      const ExecConfig& exec) {
  const Triangulation& triangulation = front.triangulation_3();
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
        if (priority(front, cells[c], i) < front.infinity()) part.emplace_back(cells[c], i);
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
  enum class Side : std::uint8_t { unknown, as_is, turned };
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
  std::vector<std::pair<Point, std::size_t>> input;
  input.reserve(points.size());
  for (const Point3& p : points) input.emplace_back(Point(p[0], p[1], p[2]), input.size());
  Triangulation triangulation(input.begin(), input.end());
  const BoundedEdges priority{max_edge};
  Front front(triangulation, priority);
  if (triangulation.dimension() < 3) return {};
  triangulation.set_seeds(possible_triangles(front, priority, exec));
  front.run();
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
