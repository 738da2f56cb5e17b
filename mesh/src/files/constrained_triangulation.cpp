// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "constrained_triangulation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {
namespace {

__extension__ using Wide = __int128;
using GridPoint = ConstrainedTriangulation::GridPoint;

// Nearer than this, points and edges are one [grid units], 1e-12 of the polygon: where edges lie on
// one another but for rounding, crossings would breed crossings.
constexpr double kNear = 1024;

int sign_of(Wide x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// Twice the area of a triangle, positive if it turns to the left. Differences have 53 bits.
Wide turn_of(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return Wide{b.x - a.x} * (c.y - a.y) - Wide{b.y - a.y} * (c.x - a.x);
}

// Whether p lies inside the circle through a, b, c, which turn to the left. Sums of products of two
// numbers of 107 bits, in digits of 52 bits.
bool is_in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& p) {
  constexpr int kDigit = 52;
  constexpr Wide kMask = (Wide{1} << kDigit) - 1;
  Wide high = 0, middle = 0, low = 0;
  const auto add = [&](const GridPoint& q, const GridPoint& r, const GridPoint& s) {
    const Wide x = q.x - p.x, y = q.y - p.y;
    const Wide square = x * x + y * y, turn = turn_of(p, r, s);
    const Wide s1 = square >> kDigit, s0 = square & kMask;
    const Wide t1 = turn >> kDigit, t0 = turn & kMask;
    high += s1 * t1;
    middle += s1 * t0 + s0 * t1;
    low += s0 * t0;
  };
  add(a, b, c);
  add(b, c, a);
  add(c, a, b);
  middle += low >> kDigit;
  high += middle >> kDigit;
  return high > 0 || (high == 0 && ((middle & kMask) != 0 || (low & kMask) != 0));
}

double distance(const GridPoint& a, const GridPoint& b) {
  const auto x = static_cast<double>(b.x - a.x), y = static_cast<double>(b.y - a.y);
  return std::sqrt(x * x + y * y);
}

// Whether p lies almost on the way from a to b, and not at its ends.
bool is_on_way(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  const double length = distance(a, b);
  if (std::abs(static_cast<double>(turn_of(a, b, p))) > kNear * length) return false;
  const double along =
      static_cast<double>(Wide{p.x - a.x} * (b.x - a.x) + Wide{p.y - a.y} * (b.y - a.y)) / length;
  return along > kNear && along < length - kNear;
}

ConstrainedTriangulation::Point between(const ConstrainedTriangulation::Point& a,
                                        const ConstrainedTriangulation::Point& b, double t) {
  return {(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1], (1 - t) * a[2] + t * b[2]};
}

}  // namespace

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

// A square far enough away that most edges of the points' hull are edges of theirs.
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

// The other diagonal of the two triangles at an edge. Of the edges round them, that behind the
// twin takes the edge's place, and that behind the edge takes the twin's.
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

// From the edges on the stack on.
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

// Walks from an edge's triangle towards the point. Such a walk ends among Delaunay triangles; where
// it might go in circles, all are looked at.
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

// The node at or near a point, a new one unless there is one; kNone if the budget is used up.
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

// In rounds that double the number of corners, chosen by a hash, each along the chain: the
// expected number of flips is linear whatever the corners' order, and walks are short.
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

// An edge that is gone along there and back bounds nothing.
void ConstrainedTriangulation::collect_constraints() {
  constraints_.clear();
  for (std::size_t i = 0; i < node_of_.size(); ++i) {
    const Index a = node_of_[i], b = node_of_[(i + 1) % node_of_.size()];
    if (a != b) constraints_.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
  }
  std::sort(constraints_.begin(), constraints_.end(), [](const auto& a, const auto& b) {
    return std::pair(a.from, a.to) > std::pair(b.from, b.to);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < constraints_.size();) {
    Constraint sum = constraints_[i];
    for (++i; i < constraints_.size() && constraints_[i].from == sum.from &&
              constraints_[i].to == sum.to;
         ++i) {
      sum.count += constraints_[i].count;
    }
    if (sum.count != 0) constraints_[kept++] = sum;
  }
  constraints_.resize(kept);
}

// The edge across which the constraint leaves its first node, at the left of whose triangle that
// node stands. If it runs along an edge there, that is marked and is_done; the rest of a longer one
// is put back.
ConstrainedTriangulation::Index ConstrainedTriangulation::leave(const Constraint& constraint,
                                                                bool& is_done) {
  const auto [a, b, count] = constraint;
  const GridPoint from = nodes_[a].at, to = nodes_[b].at;
  const auto is_ahead = [&](const GridPoint& p) {
    return Wide{p.x - from.x} * (to.x - from.x) + Wide{p.y - from.y} * (to.y - from.y) > 0;
  };
  const Index first = edge_of_[a];
  Index edge = first;
  do {
    if (!spend(1)) return kNone;
    const Index u = origin_[next(edge)], w = apex(edge);
    const int right = side(a, b, nodes_[u].at);
    if (right == 0 && is_ahead(nodes_[u].at)) {
      add_flow(edge, count);
      if (u != b) constraints_.push_back({u, b, count});
      is_done = true;
      return edge;
    }
    if (right < 0 && side(a, b, nodes_[w].at) > 0) return next(edge);
    edge = twin_[before(edge)];
  } while (edge != first);
  return kNone;
}

bool ConstrainedTriangulation::lay(const Constraint& constraint) {
  const auto [a, b, count] = constraint;
  const GridPoint from = nodes_[a].at, to = nodes_[b].at;
  const auto passes = [&](Index node) {
    if (node == constraint.to || !is_on_way(from, to, nodes_[node].at)) return false;
    constraints_.push_back({node, constraint.to, constraint.count});
    constraints_.push_back({constraint.from, node, constraint.count});
    return true;
  };
  bool is_done = false;
  Index edge = leave(constraint, is_done);
  if (is_done) return true;
  if (edge == kNone) return false;
  if (passes(origin_[edge]) || passes(origin_[next(edge)])) return true;
  const auto rim = [this](Index node, Index e) { return Rim{node, e, twin_[e], flow_[e]}; };
  // Each rim from a on: to the right in the direction of its edges, to the left against it.
  hole_.assign(1, edge - edge % 3);
  right_.assign({{a}, rim(origin_[edge], before(edge))});
  left_.assign({{a}, rim(origin_[next(edge)], next(edge))});
  Index end = kNone;
  while (end == kNone) {
    if (!spend(1)) return false;
    if (flow_[edge] != 0) return cross(constraint, edge);
    const Index twin = twin_[edge], x = apex(twin);
    const int where = side(a, b, nodes_[x].at);
    if (where != 0 && passes(x)) return true;
    hole_.push_back(twin - twin % 3);
    if (where >= 0) left_.push_back(rim(x, before(twin)));
    if (where <= 0) right_.push_back(rim(x, next(twin)));
    if (where == 0) end = x;
    edge = where > 0 ? next(twin) : before(twin);
  }
  if (end != b) constraints_.push_back({end, b, count});
  return fill_hole({a, end, count});
}

// Where the constraint crosses another, both get a node and are laid anew.
bool ConstrainedTriangulation::cross(const Constraint& constraint, Index edge) {
  const auto [a, b, count] = constraint;
  const Index u = origin_[edge], w = origin_[next(edge)];
  const GridPoint p = nodes_[a].at, q = nodes_[b].at, r = nodes_[u].at, s = nodes_[w].at;
  // Exact before the divisions, whose rounding moves the crossing by a grid unit at most.
  const auto share = [](Wide x, Wide y) {
    return static_cast<double>(x) / (static_cast<double>(x) - static_cast<double>(y));
  };
  const double t = share(turn_of(r, s, p), turn_of(r, s, q));
  const double other = share(turn_of(p, q, r), turn_of(p, q, s));
  const auto at = [t](std::int64_t from, std::int64_t to) {
    return from + std::llround(t * static_cast<double>(to - from));
  };
  const Point middle = between(between(nodes_[a].position, nodes_[b].position, t),
                               between(nodes_[u].position, nodes_[w].position, other), 0.5);
  const std::int32_t through = flow_[edge];
  add_flow(edge, -through);
  const std::size_t before_it = nodes_.size();
  const Index node = insert({at(p.x, q.x), at(p.y, q.y)}, kNone, middle, edge);
  if (node == kNone) return false;
  if (nodes_.size() > before_it) {
    if (budget_->crossings == 0) return false;
    --budget_->crossings;
  }
  for (const Constraint& part :
       {Constraint{a, node, count}, {node, b, count}, {u, node, through}, {node, w, through}}) {
    if (part.from != part.to) constraints_.push_back(part);
  }
  return true;
}

// Fills the triangles that a constraint crosses anew, so that it is an edge.
bool ConstrainedTriangulation::fill_hole(const Constraint& constraint) {
  // The left rim turned round: from the constraint's end, along its edges.
  chain_.assign(1, {constraint.to});
  for (std::size_t i = left_.size() - 1; i > 0; --i) {
    Rim rim = left_[i];
    rim.node = left_[i - 1].node;
    chain_.push_back(rim);
  }
  left_.swap(chain_);
  rims_.clear();
  const Index right = fill_side(right_), left = fill_side(left_);
  if (right == kNone || left == kNone || !hole_.empty()) return false;
  // An edge of the rim may stand on it twice, once from each side.
  for (const Rim& rim : rims_) {
    const Index moved = rim.twin == kNone ? kNone : moved_[rim.twin];
    link(moved_[rim.edge], moved == kNone ? rim.twin : moved);
  }
  for (const Rim& rim : rims_) moved_[rim.edge] = kNone;
  link(left, right);
  flow_[left] = constraint.count;
  flow_[right] = -constraint.count;
  make_delaunay();
  return true;
}

// Puts an edge of the hole into the triangle that has it now.
void ConstrainedTriangulation::attach(const Rim& rim, Index edge) {
  flow_[edge] = rim.flow;
  if (rim.is_new) {
    link(edge, rim.edge);
  } else {
    moved_[rim.edge] = edge;
    rims_.push_back(rim);
  }
  stack_.push_back(edge);
}

// One side of the hole, a polygon of the rim and the constraint, in each of whose points the
// constraint can be seen; there Graham's scan cuts triangles that fill it. Returns the constraint's
// edge.
ConstrainedTriangulation::Index ConstrainedTriangulation::fill_side(std::vector<Rim>& rim) {
  std::size_t top = 0;
  for (std::size_t i = 1; i < rim.size(); ++i) {
    Rim add = rim[i];
    while (top > 0 && side(rim[top - 1].node, rim[top].node, nodes_[add.node].at) > 0) {
      if (hole_.empty()) return kNone;
      const Index edge = hole_.back();
      hole_.pop_back();
      set_triangle(edge, rim[top - 1].node, rim[top].node, add.node);
      attach(rim[top], edge);
      attach(add, edge + 1);
      flow_[edge + 2] = 0;
      add = {add.node, edge + 2, kNone, 0, true};
      --top;
    }
    rim[++top] = add;
  }
  return top == 1 && rim[1].is_new ? rim[1].edge : kNone;
}

std::vector<ConstrainedTriangulation::Triangle> ConstrainedTriangulation::inside() const {
  std::vector<std::int64_t> winding(origin_.size() / 3, 0);
  std::vector<char> is_known(winding.size(), 0);
  std::vector<Index> open{edge_of_[0] / 3};  // at the square's corner: outside
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
