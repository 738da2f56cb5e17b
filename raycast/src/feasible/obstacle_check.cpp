// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>

namespace viewgain::detail {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& indices : mesh.triangles) {
    Triangle& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& v = mesh.vertices[indices[i]];
      triangle[i] = {v[0], v[1], v[2]};
    }
  }
  return triangles;
}

bool is_closed(const TriangleMesh& mesh) {
  using Corner = std::array<double, 3>;
  std::vector<Corner> corners(mesh.vertices.begin(), mesh.vertices.end());
  std::sort(corners.begin(), corners.end());
  const auto number = [&](std::uint32_t index) {
    return std::lower_bound(corners.begin(), corners.end(), Corner(mesh.vertices[index])) -
           corners.begin();
  };
  // Each edge with its ends in order, and the direction in which it is used.
  using Edge = std::tuple<std::ptrdiff_t, std::ptrdiff_t, int>;
  std::vector<Edge> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::ptrdiff_t from = number(triangle[i]), to = number(triangle[(i + 1) % 3]);
      if (from != to)
        edges.emplace_back(std::min(from, to), std::max(from, to), from < to ? 1 : -1);
    }
  }
  std::sort(edges.begin(), edges.end());
  int balance = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [low, high, direction] = edges[i];
    balance += direction;
    const bool last = i + 1 == edges.size() || std::get<0>(edges[i + 1]) != low ||
                      std::get<1>(edges[i + 1]) != high;
    if (last && balance != 0) return false;
  }
  return !edges.empty();
}

Box bounds_of(const Triangle& triangle) {
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    box.min[k] = low;
    box.max[k] = high;
  }
  return box;
}

std::vector<Box> bounds_of(const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& triangle : triangles) boxes.push_back(bounds_of(triangle));
  return boxes;
}

Box around(std::span<const Triangle> triangles) {
  Box box = bounds_of(triangles.front());
  for (const Triangle& triangle : triangles) {
    const Box other = bounds_of(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], other.min[k]);
      box.max[k] = std::max(box.max[k], other.max[k]);
    }
  }
  return box;
}

// Winding number of a closed mesh around a point, from the solid angles of its triangles (Van
// Oosterom and Strackee 1983).
double winding_number(std::span<const Triangle> triangles, const Eigen::Vector3d& p) {
  double half_angle = 0;
  for (const Triangle& triangle : triangles) {
    const Eigen::Vector3d a = triangle[0] - p, b = triangle[1] - p, c = triangle[2] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    half_angle +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angle / (2.0 * std::numbers::pi);
}

// Direction in which the half-line from p along +x crosses a triangle: 1, -1, or 0 without a
// crossing. Empty if it passes an edge too closely to decide.
std::optional<int> crossing(const Triangle& triangle, const Eigen::Vector3d& p) {
  std::array<double, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = triangle[i];
    const Eigen::Vector3d& b = triangle[(i + 1) % 3];
    const double left = (b.y() - a.y()) * (p.z() - a.z());
    const double right = (b.z() - a.z()) * (p.y() - a.y());
    side[i] = left - right;
    if (std::abs(side[i]) <= 1e-14 * (std::abs(left) + std::abs(right))) return std::nullopt;
  }
  if ((side[0] > 0) != (side[1] > 0) || (side[0] > 0) != (side[2] > 0)) return 0;
  const double x =
      (side[1] * triangle[0].x() + side[2] * triangle[1].x() + side[0] * triangle[2].x()) /
      (side[0] + side[1] + side[2]);
  if (x < p.x()) return 0;
  return side[0] > 0 ? 1 : -1;
}

std::vector<Triangle> all_triangles(const Obstacles& obstacles) {
  std::vector<Triangle> triangles;
  for (const TriangleMesh& mesh : obstacles.meshes) {
    const std::vector<Triangle> more = triangles_of(mesh);
    triangles.insert(triangles.end(), more.begin(), more.end());
  }
  return triangles;
}

}  // namespace

ObstacleCheck::ObstacleCheck(const Obstacles& obstacles)
    : boxes_(obstacles.boxes),
      triangles_(all_triangles(obstacles)),
      triangle_boxes_(bounds_of(triangles_)) {
  std::uint32_t first = 0;
  for (const TriangleMesh& mesh : obstacles.meshes) {
    const auto last = first + static_cast<std::uint32_t>(mesh.triangles.size());
    if (is_closed(mesh)) {
      const auto own = std::span(triangles_).subspan(first, last - first);
      solids_.push_back({around(own), first, last});
    }
    first = last;
  }
}

bool ObstacleCheck::encloses(const Solid& solid, const Eigen::Vector3d& point) const {
  if (!solid.bounds.contains(point.x(), point.y(), point.z())) return false;
  int windings = 0;
  bool is_clear = true;
  const Box ahead{{point.x(), point.y(), point.z()}, {solid.bounds.max[0], point.y(), point.z()}};
  (void)triangle_boxes_.any(ahead, [&](std::uint32_t i) {
    if (i < solid.first || i >= solid.last) return false;
    const std::optional<int> way = crossing(triangles_[i], point);
    is_clear = way.has_value();
    windings += way.value_or(0);
    return !is_clear;
  });
  if (is_clear) return windings != 0;
  const auto own = std::span(triangles_).subspan(solid.first, solid.last - solid.first);
  return std::abs(winding_number(own, point)) > 0.5;
}

bool ObstacleCheck::overlaps(const OrientedBox& body, const Eigen::Vector3d& body_center) const {
  const Box range = body.bounds();
  if (std::any_of(boxes_.begin(), boxes_.end(),
                  [&](const Box& box) { return boxes_meet(box, range) && body.overlaps(box); })) {
    return true;
  }
  if (triangle_boxes_.any(range, [&](std::uint32_t i) { return body.overlaps(triangles_[i]); })) {
    return true;
  }
  // No triangle touches the body, so it is entirely inside a solid or entirely outside.
  return is_in_mesh(body_center);
}

bool ObstacleCheck::enclose(const Eigen::Vector3d& point, double touch) const {
  const auto is_inside = [&](const Box& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = point[static_cast<Eigen::Index>(k)];
      if (!(box.min[k] + touch < x && x < box.max[k] - touch)) return false;
    }
    return true;
  };
  return std::any_of(boxes_.begin(), boxes_.end(), is_inside) || is_in_mesh(point);
}

bool ObstacleCheck::is_in_mesh(const Eigen::Vector3d& point) const {
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const Solid& solid) { return encloses(solid, point); });
}

}  // namespace viewgain::detail
