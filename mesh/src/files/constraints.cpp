// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Inserts constraints into the triangulation, edge by edge.

#include <algorithm>
#include <cmath>
#include <utility>

#include "constrained_triangulation.hpp"

namespace viewgain::detail {
namespace {

ConstrainedTriangulation::Point between(const ConstrainedTriangulation::Point& a,
                                        const ConstrainedTriangulation::Point& b, double t) {
  return {(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1], (1 - t) * a[2] + t * b[2]};
}

}  // namespace

// An edge that the chain passes once in each direction bounds nothing.
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

// The edge across which the constraint leaves the triangles at its first node. If the constraint
// runs along an existing edge, marks that edge, sets is_done, and queues the rest of a longer
// constraint.
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
  // Both rims begin at a: the right one along its edges, the left one against them.
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

// If the constraint crosses another, both get a node there and are inserted again.
bool ConstrainedTriangulation::cross(const Constraint& constraint, Index edge) {
  const auto [a, b, count] = constraint;
  const Index u = origin_[edge], w = origin_[next(edge)];
  const GridPoint p = nodes_[a].at, q = nodes_[b].at, r = nodes_[u].at, s = nodes_[w].at;
  // Exact up to the divisions, whose rounding moves the crossing by at most one grid unit.
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

// Retriangulates the triangles that a constraint crosses, so that it becomes an edge.
bool ConstrainedTriangulation::fill_hole(const Constraint& constraint) {
  // The left rim reversed, so that it begins at the constraint's end and follows its edges.
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
  // An edge can be on the rim twice, once from each side.
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

// Connects an edge of the hole to the triangle that now has it.
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

// Fills one side of the hole, the polygon between rim and constraint. Graham's scan can do this,
// because the constraint is visible from every point of the polygon. Returns the constraint's edge.
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

}  // namespace viewgain::detail
