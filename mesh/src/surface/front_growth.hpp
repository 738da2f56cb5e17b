// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "front_triangulation.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail::front {

// Private members of CGAL's class: an explicit instantiation may name them.
template <auto Member, typename Key>
struct Opened {
  friend constexpr auto opened(Key) { return Member; }
};
struct Border {
  friend constexpr auto opened(Border);
};
struct Bound {
  friend constexpr auto opened(Bound);
};
struct NextBound {
  friend constexpr auto opened(NextBound);
};
struct Wedge {
  friend constexpr auto opened(Wedge);
};
struct Initialize {
  friend constexpr auto opened(Initialize);
};
template struct Opened<&Front::_ordered_border, Border>;
template struct Opened<&Front::K, Bound>;
template struct Opened<&Front::min_K, NextBound>;
template struct Opened<&Front::COS_BETA, Wedge>;
template struct Opened<&Front::initialize_vertices_and_cells, Initialize>;

/// Grows the front to the same triangles as Front::run(). Front::run() recomputes all edges of the
/// border whenever the bound on the ratio of radii rises. This took half of the time for the
/// surface of a room. Here, an edge waits if its best triangle is too large for the bound, or if it
/// has none. While the front grows, triangles can only become impossible. A waiting edge is
/// therefore recomputed only if the bound reaches its ratio, or if a triangle that it depends on
/// became impossible.
class FrontGrowth {
 public:
  FrontGrowth(Front& front, const BoundedEdges& priority) : front_(front), priority_(priority) {}

  void run() {
    if (front_.triangulation_3().dimension() < 3) return;
    front_.*opened(Bound{}) = kFirstBound;
    front_.*opened(Wedge{}) = std::cos(kBeta);
    (front_.*opened(Initialize{}))();
    for (bool again = false; (again = front_.init(again));) {
      extend();
      // CGAL's postprocessing visits all vertices, but only forgets their requests: it would remove
      // outliers if they were fewer than a tenth of a size that CGAL leaves at 0.
      const auto vertices = static_cast<int>(front_.triangulation_3().number_of_vertices());
      if (has_requests_ && front_.number_of_facets() > vertices) {
        if (front_.postprocessing())
          throw Error(ErrorCode::backend, "CGAL removed outliers; its version is not supported");
        has_requests_ = false;
      }
    }
  }

 private:
  using Edge = Front::Edge_incident_facet;  // an edge, seen from a triangle
  using Item = Front::Radius_ptr_type;
  using Ends = Front::Edge_like;

  // CGAL's constants.
  static constexpr double kFirstBound = 5, kBeta = 0.52, kLeastBound = 1.1, kStep = 0.1,
                          kBeyond = 1e-7;
  static constexpr double kTooLarge = 3, kTooLargeStill = 4;  // values of waiting edges
  static constexpr double kNearly = 1 + 1e-9;                 // for the rounding of ratios

  [[nodiscard]] static Front::Vertex_handle vertex(const Edge& e, int corner) {
    return e.first.first->vertex(corner);
  }
  [[nodiscard]] static Front::Vertex_handle third(const Edge& e) {
    return vertex(e, 6 - e.second - e.first.second - e.first.third);
  }
  [[nodiscard]] static Ends ends(const Edge& e) {
    return {vertex(e, e.first.second), vertex(e, e.first.third)};
  }

  void extend() {
    double &bound = front_.*opened(Bound{}), &next = front_.*opened(NextBound{}), before = 0;
    bound = kLeastBound;
    if (border_.empty()) return;
    do {
      next = front_.infinity();
      do {
        if (border_.begin()->first >= kTooLarge) {
          recompute();
        } else {
          advance();
        }
      } while (!border_.empty() && border_.begin()->first < kTooLargeStill);
      before = bound;
      bound += std::max(kStep, next - bound + kBeyond);
    } while (!border_.empty() && next != front_.infinity() && bound != before);
  }

  // Adds the best triangle at the border, or puts its edge back.
  void advance() {
    const auto first = border_.begin();
    const double value = first->first;
    const Front::IO_edge_type edge = *first->second;
    border_.erase(first);
    const Front::Validation_case result = front_.validate(edge.second, value);
    if (result == Front::NOT_VALID_CONNECTING_CASE) {
      Ends key = ends(edge.first);
      (void)front_.is_border_elt(key);  // in the border's direction
      front_.set_incidence_request(third(edge.second), value, key);
      has_requests_ = true;
    } else if (result == Front::NOT_VALID) {
      const Front::Radius_edge_type computed = front_.compute_value(edge.first);
      if (computed != Front::Radius_edge_type(value, edge))
        border_.insert(placed(edge.first, computed));
    }
  }

  // Recomputes the waiting edges that can change with the current bound. Computes the next bound.
  void recompute() {
    double& next = front_.*opened(NextBound{});
    std::vector<Front::IO_edge_type*> changed;
    for (auto item = border_.begin(); item != border_.end();) {
      if (waits(*item)) {
        next = std::min(next, item->ratio);
        ++item;
      } else {
        changed.push_back(item->second);
        item = border_.erase(item);
      }
    }
    for (Front::IO_edge_type* const place : changed) {
      const Edge edge = place->first;
      const double next_of_others = std::exchange(next, front_.infinity());
      Front::Radius_edge_type computed = front_.compute_value(edge);
      if (computed.first == kTooLarge) computed.first = kTooLargeStill;
      Item item = placed(edge, computed);
      item.is_waiting = computed.first > kTooLarge;
      item.ratio = next;
      if (computed.first == kTooLargeStill) {
        item.thirds.push_back(third(computed.second.second));
      } else if (item.is_waiting) {
        item.thirds = possible_thirds(edge);
      }
      item.faces = faces_around(item.thirds);
      border_.insert(std::move(item));
      next = std::min(next, next_of_others);
    }
  }

  // Whether CGAL would find the same for the edge. A triangle becomes impossible if its third
  // corner gets inside the surface, or an edge to it; both add a triangle of the surface to this
  // corner.
  [[nodiscard]] bool waits(const Item& item) const {
    return item.is_waiting && item.ratio > kNearly * front_.*opened(Bound{}) &&
           faces_around(item.thirds) == item.faces;
  }

  [[nodiscard]] static std::size_t faces_around(const std::vector<Front::Vertex_handle>& corners) {
    std::size_t faces = 0;
    for (const auto corner : corners) faces += corner->faces;
    return faces;
  }

  // The third corners of triangles that compute_value() chooses from.
  [[nodiscard]] std::vector<Front::Vertex_handle> possible_thirds(const Edge& edge) const {
    std::vector<Front::Vertex_handle> thirds;
    const auto [from, to] = ends(edge);
    for (Edge e = front_.next(edge); e.first.first != edge.first.first; e = front_.next(e)) {
      if (front_.triangulation_3().is_infinite(Facet(e.first.first, e.second))) continue;
      const auto corner = third(e);
      if (priority_(front_, e.first.first, e.second) < front_.infinity() &&
          corner->not_interior() && !front_.is_interior_edge(Ends(from, corner)) &&
          !front_.is_interior_edge(Ends(to, corner))) {
        thirds.push_back(corner);
      }
    }
    return thirds;
  }

  // Stores what was computed for an edge of the border.
  Item placed(const Edge& edge, const Front::Radius_edge_type& computed) {
    Ends key = ends(edge);
    Front::Border_elt element;
    (void)front_.is_border_elt(key, element);
    return {computed.first,
            front_.set_again_border_elt(key.first, key.second, {computed, element.second})};
  }

  Front& front_;
  BoundedEdges priority_;
  Front::Ordered_border_type& border_ = front_.*opened(Border{});
  bool has_requests_ = false;  // since the last postprocessing
};

}  // namespace viewgain::detail::front
