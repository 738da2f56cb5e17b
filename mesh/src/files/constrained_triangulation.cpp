// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "constrained_triangulation.hpp"

#include <algorithm>
#include <bit>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {

int ConstrainedTriangulation::side(Index a, Index b, const GridPoint& p) const {
  return sign_of(turn_of(nodes_[a].at, nodes_[b].at, p));
}

bool ConstrainedTriangulation::spend(std::size_t steps) {
  if (budget_->steps < steps) return false;
  budget_->steps -= steps;
  return true;
}

bool ConstrainedTriangulation::build(const std::vector<GridPoint>& flat,
                                     const std::vector<Point>& corners, FillBudget& budget) {
  budget_ = &budget;
  start();
  if (!insert_corners(flat, corners)) return false;
  collect_constraints();
  while (!constraints_.empty()) {
    const Constraint constraint = constraints_.back();
    constraints_.pop_back();
    if (!lay(constraint)) return false;
  }
  return true;
}

// Starts with a square that is so far away that most edges of the points' hull become edges of the
// triangulation.
void ConstrainedTriangulation::start() {
  nodes_.clear();
  edge_of_.clear();
  origin_.clear();
  twin_.clear();
  flow_.clear();
  moved_.clear();
  stack_.clear();
  for (const GridPoint at : {GridPoint{-kGrid, -kGrid},
                             {2 * kGrid, -kGrid},
                             {2 * kGrid, 2 * kGrid},
                             {-kGrid, 2 * kGrid}}) {
    (void)add_node(at, kNone, {});
  }
  const Index a = add_triangle(0, 1, 2), b = add_triangle(0, 2, 3);
  link(a + 2, b);
}

ConstrainedTriangulation::Index ConstrainedTriangulation::add_node(const GridPoint& at,
                                                                   Index corner,
                                                                   const Point& position) {
  nodes_.push_back({at, corner, position});
  edge_of_.push_back(kNone);
  return static_cast<Index>(nodes_.size() - 1);
}

ConstrainedTriangulation::Index ConstrainedTriangulation::add_triangle(Index a, Index b, Index c) {
  const auto edge = static_cast<Index>(origin_.size());
  for (auto* indices : {&origin_, &twin_, &moved_}) indices->resize(edge + 3, kNone);
  flow_.resize(edge + 3, 0);
  set_triangle(edge, a, b, c);
  return edge;
}

void ConstrainedTriangulation::set_triangle(Index edge, Index a, Index b, Index c) {
  for (const Index node : {a, b, c}) {
    origin_[edge] = node;
    edge_of_[node] = edge++;
  }
}

void ConstrainedTriangulation::link(Index a, Index b) {
  twin_[a] = b;
  if (b != kNone) twin_[b] = a;
}

void ConstrainedTriangulation::add_flow(Index edge, std::int32_t count) {
  flow_[edge] += count;
  flow_[twin_[edge]] -= count;
}

// Replaces an edge by the other diagonal of its two triangles. The edge after the twin takes the
// edge's place, and the edge after the edge takes the twin's place.
void ConstrainedTriangulation::flip(Index edge) {
  const Index twin = twin_[edge], e1 = next(edge), t1 = next(twin);
  const Index a = origin_[edge], b = origin_[twin], p = apex(edge), q = apex(twin);
  const Index x = twin_[t1], y = twin_[e1];
  flow_[edge] = flow_[t1];
  flow_[twin] = flow_[e1];
  flow_[e1] = flow_[t1] = 0;
  origin_[e1] = q;
  origin_[t1] = p;
  link(edge, x);
  link(twin, y);
  link(e1, t1);
  edge_of_[a] = edge;
  edge_of_[b] = twin;
  edge_of_[p] = t1;
  edge_of_[q] = e1;
}

bool ConstrainedTriangulation::is_delaunay(Index edge) const {
  const Index twin = twin_[edge];
  return twin == kNone || flow_[edge] != 0 ||
         !is_in_circle(nodes_[origin_[edge]].at, nodes_[origin_[twin]].at, nodes_[apex(edge)].at,
                       nodes_[apex(twin)].at);
}

// Flips edges, beginning with those on the stack.
void ConstrainedTriangulation::make_delaunay() {
  while (!stack_.empty()) {
    const Index edge = stack_.back();
    stack_.pop_back();
    if (is_delaunay(edge) || !spend(1)) continue;
    const Index twin = twin_[edge];
    flip(edge);
    for (const Index e : {edge, before(edge), twin, before(twin)}) stack_.push_back(e);
  }
}

// Walks from an edge's triangle towards the point. The walk ends in a Delaunay triangulation; if it
// could run in circles, all triangles are searched.
ConstrainedTriangulation::Index ConstrainedTriangulation::triangle_at(const GridPoint& p,
                                                                      Index edge) {
  edge -= edge % 3;
  for (std::size_t steps = 0; 3 * steps < origin_.size(); ++steps) {
    Index out = kNone;
    for (Index e = edge; e < edge + 3 && out == kNone; ++e) {
      if (side(origin_[e], origin_[next(e)], p) < 0) out = twin_[e];
    }
    if (!spend(1)) return kNone;
    if (out == kNone) return edge;
    edge = out - out % 3;
  }
  for (edge = 0; edge < origin_.size(); edge += 3) {
    bool holds = true;
    for (Index e = edge; e < edge + 3; ++e) {
      holds = holds && side(origin_[e], origin_[next(e)], p) >= 0;
    }
    if (!spend(1)) return kNone;
    if (holds) return edge;
  }
  return kNone;
}

// The node at or near a point, created if missing; kNone if the budget is used up.
ConstrainedTriangulation::Index ConstrainedTriangulation::insert(const GridPoint& p, Index corner,
                                                                 const Point& position,
                                                                 Index edge) {
  Index e0 = triangle_at(p, edge);
  if (e0 == kNone) return kNone;
  bool is_on_edge = false;
  for (Index e = e0, first = e0; e < first + 3; ++e) {
    if (distance(nodes_[origin_[e]].at, p) <= kNear) return origin_[e];
    if (side(origin_[e], origin_[next(e)], p) == 0) e0 = e, is_on_edge = true;
  }
  const Index e1 = next(e0), e2 = before(e0);
  const Index a = origin_[e0], b = origin_[e1], c = origin_[e2];
  const Index q = add_node(p, corner, position);
  const Index u = add_triangle(b, c, q), v = add_triangle(c, a, q);
  link(u, twin_[e1]);
  link(v, twin_[e2]);
  flow_[u] = flow_[e1];
  flow_[v] = flow_[e2];
  flow_[e1] = flow_[e2] = 0;
  origin_[e2] = q;
  link(e1, u + 2);
  link(u + 1, v + 2);
  link(v + 1, e2);
  edge_of_[a] = e0;
  edge_of_[b] = e1;
  for (const Index e : {e0, u, v}) stack_.push_back(e);
  if (is_on_edge) {  // the triangle a, b, q has no area
    const std::int32_t count = flow_[e0];
    add_flow(e0, -count);
    add_flow(v + 1, count);
    add_flow(u + 2, count);
    stack_.push_back(before(twin_[e0]));
    flip(e0);
  }
  make_delaunay();
  return q;
}

// Inserts corners in rounds that double their number, chosen by a hash, and within a round along
// the chain. The expected number of flips is then linear for any order of corners, and walks are
// short.
bool ConstrainedTriangulation::insert_corners(const std::vector<GridPoint>& flat,
                                              const std::vector<Point>& corners) {
  const auto count = static_cast<Index>(flat.size());
  node_of_.assign(count, kNone);
  const int rounds = std::bit_width(count);
  const auto round_of = [rounds](Index corner) {
    return std::min(std::countr_zero(mix64((corner + 1) * kMixStep)), rounds);
  };
  Index edge = 0;
  for (int round = rounds; round >= 0; --round) {
    for (Index i = 0; i < count; ++i) {
      if (round_of(i) != round) continue;
      const Index node = insert(flat[i], i, corners[i], edge);
      if (node == kNone) return false;
      node_of_[i] = node;
      edge = edge_of_[node];
    }
  }
  for (Index i = count; i-- > 0;) nodes_[node_of_[i]].corner = i;
  return true;
}

std::vector<ConstrainedTriangulation::Triangle> ConstrainedTriangulation::inside() const {
  std::vector<std::int64_t> winding(origin_.size() / 3, 0);
  std::vector<char> is_known(winding.size(), 0);
  std::vector<Index> open{edge_of_[0] / 3};  // at the square's corner, which is outside
  is_known[open.front()] = 1;
  while (!open.empty()) {
    const Index triangle = open.back();
    open.pop_back();
    for (Index edge = 3 * triangle; edge < 3 * triangle + 3; ++edge) {
      if (twin_[edge] == kNone || is_known[twin_[edge] / 3] != 0) continue;
      const Index other = twin_[edge] / 3;
      winding[other] = winding[triangle] - flow_[edge];
      is_known[other] = 1;
      open.push_back(other);
    }
  }
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < winding.size(); ++i) {
    if (winding[i] == 0) continue;
    const std::array<Index, 3> nodes{origin_[3 * i], origin_[3 * i + 1], origin_[3 * i + 2]};
    const Wide area = turn_of(nodes_[nodes[0]].at, nodes_[nodes[1]].at, nodes_[nodes[2]].at);
    triangles.push_back({nodes, winding[i], static_cast<double>(area)});
  }
  return triangles;
}

}  // namespace viewgain::detail
