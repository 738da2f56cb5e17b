// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_mesh.hpp"

#include <cstdint>

namespace viewgain::detail {
namespace {

void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& t : part.triangles) {
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

TriangleMesh mesh_of(const Box& box) {
  TriangleMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {
    auto& vertex = mesh.vertices.emplace_back();
    for (unsigned a = 0; a < 3; ++a) {
      vertex[a] = (corner >> a & 1U) != 0 ? box.max[a] : box.min[a];
    }
  }
  mesh.triangles.assign(kBoxTriangles.begin(), kBoxTriangles.end());
  return mesh;
}

}  // namespace

TriangleMesh join_obstacles(const Obstacles& obstacles) {
  TriangleMesh all;
  for (const Box& box : obstacles.boxes) append(all, mesh_of(box));
  for (const TriangleMesh& mesh : obstacles.meshes) append(all, mesh);
  return all;
}

}  // namespace viewgain::detail
