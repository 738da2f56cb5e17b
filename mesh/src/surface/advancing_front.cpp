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
#include <iterator>
#include <tuple>
#include <utility>

namespace viewgain::detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// CGAL compares handles to vertices and cells by address, and so the side from which it looks at a
// triangle, hence the rounding of its radius, would depend on where memory was free. Elements that
// carry the order of their making are compared by that instead.
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
  std::size_t stamp_ = static_cast<std::size_t>(-1);  // CGAL's sign for "not yet"
};

// The same for the border's edges, which CGAL keeps in a set by priority and, where priorities are
// equal, as for the edges that want the same triangle, by address.
template <typename Base>
class OrderedBorder : public Base {
 public:
  using Base::Base;
  template <typename Triangulation>
  struct Rebind_TDS {
    using Other = OrderedBorder<typename Base::template Rebind_TDS<Triangulation>::Other>;
  };

  // Stands in for the base's pair of the same name.
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

using Vertex =
    OrderedBorder<Stamped<CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>>;
using Cell = Stamped<CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

// CGAL goes through all facets for each piece of surface: here by a list of them, in their order.
class Triangulation : public Delaunay {
 public:
  using Delaunay::Delaunay;
  using Finite_facets_iterator = std::vector<Delaunay::Facet>::const_iterator;

  [[nodiscard]] Finite_facets_iterator finite_facets_begin() { return listed().begin(); }
  [[nodiscard]] Finite_facets_iterator finite_facets_end() { return listed().end(); }
  void remove(Delaunay::Vertex_handle vertex) {
    Delaunay::remove(vertex);
    facets_.clear();
  }

 private:
  const std::vector<Delaunay::Facet>& listed() {
    if (facets_.empty()) {
      facets_.assign(Delaunay::finite_facets_begin(), Delaunay::finite_facets_end());
    }
    return facets_;
  }

  std::vector<Delaunay::Facet> facets_;
};

// CGAL's own measure, the radius of the smallest empty sphere, but infinite, which means never, for
// long edges.
struct BoundedEdges {
  std::span<const double> max_edge;  // by the vertices' id

  template <typename AdvancingFront, typename CellHandle>
  double operator()(const AdvancingFront& front, CellHandle& cell, const int& index) const {
    const auto& a = *cell->vertex((index + 1) & 3);
    const auto& b = *cell->vertex((index + 2) & 3);
    const auto& c = *cell->vertex((index + 3) & 3);
    const auto is_long = [&](const auto& from, const auto& to) {
      const double most = std::max(max_edge[from.id()], max_edge[to.id()]);
      return CGAL::squared_distance(from.point(), to.point()) > most * most;
    };
    if (is_long(a, b) || is_long(b, c) || is_long(c, a)) return front.infinity();
    return front.smallest_radius_delaunay_sphere(cell, index);
  }
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> advancing_front(std::span<const Point3> points,
                                                          std::span<const double> max_edge) {
  std::vector<std::pair<Point, std::size_t>> input;
  input.reserve(points.size());
  for (const Point3& p : points) input.emplace_back(Point(p[0], p[1], p[2]), input.size());
  Triangulation triangulation(input.begin(), input.end());
  CGAL::Advancing_front_surface_reconstruction<Triangulation, BoundedEdges> front(
      triangulation, BoundedEdges{max_edge});
  front.run();
  std::vector<std::array<std::size_t, 3>> faces;
  CGAL::write_triple_indices(std::back_inserter(faces), front);
  std::vector<std::array<std::uint32_t, 3>> triangles(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) triangles[f][k] = static_cast<std::uint32_t>(faces[f][k]);
    std::rotate(triangles[f].begin(), std::min_element(triangles[f].begin(), triangles[f].end()),
                triangles[f].end());
  }
  // CGAL chooses the side of a component by address too, so the order must not depend on it.
  const auto key = [](const std::array<std::uint32_t, 3>& t) {
    return std::array{t[0], std::min(t[1], t[2]), std::max(t[1], t[2])};
  };
  std::sort(triangles.begin(), triangles.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return triangles;
}

}  // namespace viewgain::detail
