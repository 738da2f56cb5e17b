// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "polygon_fill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

using Point = std::array<double, 3>;

constexpr std::size_t kMostCorners = 1'000'000;  // of a polygon that is not a fan; takes seconds
constexpr double kNoArea = 1e-12;                // twice an area, relative to the square of a side
constexpr double kRounding = 1e-7;               // corners are rounded to single precision

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Point cross_product(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double largest(const Point& p) {
  return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
}

// Twice the area of a triangle, positive if it is counter-clockwise.
template <typename Flat>
double turn_of(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether a triangle is a line or a point, up to rounding.
bool is_line(const Point& a, const Point& b, const Point& c) {
  Point u = minus(b, a), v = minus(c, a);
  const double scale = std::max({largest(u), largest(v), largest(minus(c, b))});
  if (!(scale > 0)) return true;
  for (double& x : u) x /= scale;
  for (double& x : v) x /= scale;
  return !(largest(cross_product(u, v)) > kNoArea);
}

void add_triangle(const std::array<std::uint32_t, 3>& t, TriangleMesh& mesh) {
  const auto& at = mesh.vertices;
  if (!is_line(at[t[0]], at[t[1]], at[t[2]])) mesh.triangles.push_back(t);
}

}  // namespace

bool PolygonFill::fill(std::span<const std::uint32_t> corners, TriangleMesh& mesh,
                       FillBudget& budget) {
  if (corners.size() == 3) {
    add_triangle({corners[0], corners[1], corners[2]}, mesh);
    return false;
  }
  take(corners, mesh);
  if (corners_.size() < 3 || !has_area()) return false;
  flatten();
  if (!is_fan()) return triangulate(mesh, budget);
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    add_triangle({corners_[0], corners_[i - 1], corners_[i]}, mesh);
  }
  return false;
}

void PolygonFill::take(std::span<const std::uint32_t> corners, const TriangleMesh& mesh) {
  corners_.clear();
  points_.clear();
  const auto place = [&mesh](std::uint32_t corner) { return mesh.vertices[corner]; };
  for (const std::uint32_t corner : corners) {
    if (corners_.empty() || place(corner) != place(corners_.back())) corners_.push_back(corner);
  }
  while (corners_.size() > 1 && place(corners_.back()) == place(corners_.front())) {
    corners_.pop_back();
  }
  first_ = place(corners_.front());
  extent_ = 0;
  for (const std::uint32_t corner : corners_) {
    points_.push_back(minus(place(corner), first_));
    extent_ = std::max(extent_, largest(points_.back()));
  }
  no_area_ = kNoArea * extent_ * extent_;
}

// Drops the axis along which the normal is longest, which keeps inside and outside. If parts with
// opposite orientation leave no normal, drops the axis along which the polygon looks largest.
void PolygonFill::flatten() {
  Point normal{}, seen{};
  for (std::size_t i = 2; i < points_.size(); ++i) {
    const Point n = cross_product(points_[i - 1], points_[i]);
    for (std::size_t k = 0; k < 3; ++k) normal[k] += n[k], seen[k] += std::abs(n[k]);
  }
  const Point lengths{std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
  const Point& deciding = largest(normal) < 0.1 * largest(seen) ? seen : lengths;
  const auto axis = static_cast<std::size_t>(std::max_element(deciding.begin(), deciding.end()) -
                                             deciding.begin());
  std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(x, y);
  flat_.clear();
  for (const Point& p : points_) flat_.push_back({p[x], p[y]});
}

// Whether the fan of the first corner fills the polygon. It does not if the others go around the
// first corner more than once.
bool PolygonFill::is_fan() const {
  bool is_back = false, was_beyond = false;
  for (std::size_t i = 2; i < flat_.size(); ++i) {
    if (!(turn_of(flat_[0], flat_[i - 1], flat_[i]) > no_area_)) return false;
    const double side = turn_of(flat_[0], flat_[1], flat_[i]);
    is_back = is_back || (was_beyond && side > no_area_);
    was_beyond = was_beyond || side < 0;
  }
  return !is_back;
}

bool PolygonFill::has_area() const {
  for (std::size_t i = 2; i < points_.size(); ++i) {
    if (largest(cross_product(points_[i - 1], points_[i])) > no_area_) return true;
  }
  return false;
}

bool PolygonFill::triangulate(TriangleMesh& mesh, FillBudget& budget) {
  if (corners_.size() > kMostCorners) {
    throw Error(ErrorCode::format,
                "is concave and has more than " + std::to_string(kMostCorners) + " corners");
  }
  // Scales by a power of two, so that few coordinates are rounded.
  Flat least = flat_.front(), most = least;
  for (const Flat& p : flat_) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y)};
  }
  const int exponent = std::ilogb(std::max(most.x - least.x, most.y - least.y)) + 1;
  const auto on_grid = [exponent](double x) { return std::llround(std::ldexp(x, 50 - exponent)); };
  grid_.clear();
  for (const Flat& p : flat_) grid_.push_back({on_grid(p.x - least.x), on_grid(p.y - least.y)});
  if (!triangulation_.build(grid_, points_, budget)) {
    throw Error(ErrorCode::format, budget.crossings == 0
                                       ? "crosses itself too often"
                                       : "is too complex to be split into triangles");
  }
  const auto triangles = triangulation_.inside();
  double all = 0, wrong = 0;
  added_.clear();
  const auto vertex_of = [&](std::uint32_t node) {
    const std::uint32_t corner = triangulation_.corner_of(node);
    if (corner != ConstrainedTriangulation::kNone) return corners_[corner];
    if (added_.size() <= node) added_.resize(node + 1, ConstrainedTriangulation::kNone);
    if (added_[node] == ConstrainedTriangulation::kNone) {
      if (mesh.vertices.size() >= std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorCode::format, "needs more vertices than a mesh can have");
      }
      const Point& p = triangulation_.position_of(node);
      added_[node] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back({first_[0] + p[0], first_[1] + p[1], first_[2] + p[2]});
    }
    return added_[node];
  };
  for (const auto& triangle : triangles) {
    std::array<std::uint32_t, 3> t{};
    for (std::size_t k = 0; k < 3; ++k) t[k] = vertex_of(triangle.nodes[k]);
    if (triangle.winding < 0) std::swap(t[1], t[2]);
    add_triangle(t, mesh);
    all += triangle.twice_area;
    if (triangle.winding != 1) wrong += triangle.twice_area;
  }
  return wrong > kRounding * all;
}

}  // namespace viewgain::detail
