// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/painted_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace viewgain::app {

using Eigen::Vector3d;

std::pair<Vector3d, Vector3d> tangents(const Vector3d& n) {
  const Vector3d helper = std::abs(n.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d u = n.cross(helper).normalized();
  return {u, n.cross(u)};
}

std::uint8_t PaintedMesh::add_paint(const Paint& paint) {
  paints_.push_back(paint);
  return static_cast<std::uint8_t>(paints_.size() - 1);
}

void PaintedMesh::add_hexahedron(const std::array<Vector3d, 8>& corners, std::uint8_t paint) {
  Part& part = part_for(paint);
  const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
  for (const Vector3d& p : corners) part.mesh.vertices.push_back({p.x(), p.y(), p.z()});
  for (const auto& t : kBoxTriangles) {
    part.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    part.paint_of_triangle.push_back(paint);
  }
}

void PaintedMesh::add_surface(const std::vector<std::array<double, 3>>& vertices,
                              const std::vector<std::array<double, 3>>& normals,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              std::uint8_t paint) {
  add_surface(vertices, normals, triangles, std::vector(triangles.size(), paint));
}

void PaintedMesh::add_surface(const std::vector<std::array<double, 3>>& vertices,
                              const std::vector<std::array<double, 3>>& normals,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              const std::vector<std::uint8_t>& paint_of_triangle) {
  if (triangles.empty()) return;
  Part& part = part_for(paint_of_triangle.front());
  const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
  part.mesh.vertices.insert(part.mesh.vertices.end(), vertices.begin(), vertices.end());
  part.normals.resize(first, Vector3d::Zero());
  for (const auto& n : normals) part.normals.emplace_back(n[0], n[1], n[2]);
  for (const auto& t : triangles) {
    part.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  part.paint_of_triangle.insert(part.paint_of_triangle.end(), paint_of_triangle.begin(),
                                paint_of_triangle.end());
}

Vector3d PaintedMesh::Part::shading_normal(std::uint32_t triangle, const Vector3d& point,
                                           const Vector3d& normal) const {
  const auto& t = mesh.triangles[triangle];
  if (std::max({t[0], t[1], t[2]}) >= normals.size()) return normal;
  const auto vertex = [&](std::size_t k) {
    return Eigen::Map<const Vector3d>(mesh.vertices[t[k]].data());
  };
  // Each corner's share is the area of the triangle between the point and the opposite edge.
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d a = vertex((k + 1) % 3) - point, b = vertex((k + 2) % 3) - point;
    sum += a.cross(b).norm() * normals[t[k]];
  }
  if (!(sum.norm() > 0)) return normal;
  return sum.dot(normal) < 0 ? Vector3d(-sum.normalized()) : Vector3d(sum.normalized());
}

void PaintedMesh::add_line(const Vector3d& a, const Vector3d& b, double width, std::uint8_t paint) {
  const auto [u, v] = tangents((b - a).normalized());
  std::array<Vector3d, 8> corners;
  for (unsigned k = 0; k < 8; ++k) {
    corners[k] = ((k & 4U) != 0 ? b : a) + ((k & 1U) != 0 ? 0.5 : -0.5) * width * u +
                 ((k & 2U) != 0 ? 0.5 : -0.5) * width * v;
  }
  add_hexahedron(corners, paint);
}

}  // namespace viewgain::app
