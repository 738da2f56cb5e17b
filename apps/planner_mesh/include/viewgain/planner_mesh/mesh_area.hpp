// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace viewgain {

/// Total area of a mesh's triangles [m²]; indices must be valid.
template <typename Mesh>
[[nodiscard]] double mesh_area(const Mesh& mesh) {
  double area = 0;
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) {
      return Eigen::Vector3d(mesh.vertices[triangle[i]].data());
    };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return area;
}

}  // namespace viewgain
