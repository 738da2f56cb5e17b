// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "gather_scene.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"

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
    for (unsigned a = 0; a < 3; ++a) vertex[a] = (corner >> a & 1U) != 0 ? box.max[a] : box.min[a];
  }
  mesh.triangles.assign(kBoxTriangles.begin(), kBoxTriangles.end());
  return mesh;
}

}  // namespace

void check_obstacles(const Obstacles& obstacles) {
  for (const Box& box : obstacles.boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis]) ||
          box.min[axis] >= box.max[axis]) {
        refuse("an obstacle box is inside out or not finite");
      }
    }
  }
  for (const TriangleMesh& mesh : obstacles.meshes) {
    for (const auto& vertex : mesh.vertices) {
      for (const double c : vertex) {
        if (!std::isfinite(static_cast<float>(c))) {
          refuse("an obstacle has a vertex that is not finite");
        }
      }
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= mesh.vertices.size()) {
          refuse("an obstacle's triangle refers to vertex " + std::to_string(index) +
                 ", but the mesh has " + std::to_string(mesh.vertices.size()) + " vertices");
        }
      }
    }
  }
}

void check_surroundings(const Surroundings& surroundings) {
  check_obstacles(surroundings.obstacles);
  if (surroundings.support_plane && !std::isfinite(*surroundings.support_plane)) {
    refuse("the height of the support plane must be finite");
  }
}

std::unique_ptr<SceneData> gather_scene(GridSnapshot snapshot,
                                        std::shared_ptr<const Surroundings> surroundings,
                                        std::shared_ptr<const HazardConfig> hazard,
                                        const SceneData* before) {
  auto data = std::make_unique<SceneData>();
  data->snapshot = std::move(snapshot);
  gather_primitives(*data, before);
  const Obstacles& obstacles = surroundings->obstacles;
  data->has_obstacles = !obstacles.boxes.empty() || !obstacles.meshes.empty();
  data->surroundings = std::move(surroundings);
  data->hazard = std::move(hazard);
  return data;
}

TriangleMesh join_obstacles(const Obstacles& obstacles) {
  TriangleMesh all;
  for (const Box& box : obstacles.boxes) append(all, mesh_of(box));
  for (const TriangleMesh& mesh : obstacles.meshes) append(all, mesh);
  return all;
}

}  // namespace viewgain::detail
