// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// CGAL's assertions print before they throw.
#define CGAL_NDEBUG 1

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Advancing_front_surface_reconstruction_cell_base_3.h>
#include <CGAL/Advancing_front_surface_reconstruction_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_3.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace viewgain::detail::front {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

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
// equal, as for edges with the same best triangle. FrontGrowth notes here what an edge waits for.
template <typename Base>
class OrderedBorder : public Base {
 public:
  using Base::Base;
  OrderedBorder() { this->id() = 0; }  // also for the vertex that CGAL adds to flat input
  template <typename Triangulation>
  struct Rebind_TDS {
    using Other = OrderedBorder<typename Base::template Rebind_TDS<Triangulation>::Other>;
  };

  // Replaces the base's pair of the same name.
  struct Radius_ptr_type {
    typename Base::criteria first;
    typename Base::IO_edge_type* second;
    std::size_t from, to;
    bool is_waiting = false;
    double ratio = 0;  ///< of radii, from which on the edge's best triangle is good enough
    std::vector<typename Base::Vertex_handle> thirds;  ///< corners of triangles that matter
    std::size_t faces = 0;                             ///< of the thirds, when it began to wait

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

  std::size_t faces = 0;  ///< triangles of the surface around the vertex
};

// Keeps the radii of a cell's four facets inside the cell, so that threads can set them. CGAL's own
// cell allocates them when the first is known. Counts the surface's triangles around a vertex.
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
  void select_facet(int facet) {
    Base::select_facet(facet);
    for (const int corner : {1, 2, 3}) ++this->vertex((facet + corner) & 3)->faces;
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

}  // namespace viewgain::detail::front
