// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "gather_scene.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "scene_primitives.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {

void check_obstacles(const Obstacles& obstacles) {
  for (const Box& box : obstacles.boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis]) ||
          box.min[axis] >= box.max[axis]) {
        throw Error(ErrorCode::invalid_argument, "an obstacle box is inside out or not finite");
      }
    }
  }
  for (const TriangleMesh& mesh : obstacles.meshes) {
    for (const auto& vertex : mesh.vertices) {
      for (const double c : vertex) {
        if (!std::isfinite(static_cast<float>(c))) {
          throw Error(ErrorCode::invalid_argument, "an obstacle has a vertex that is not finite");
        }
      }
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= mesh.vertices.size()) {
          throw Error(ErrorCode::invalid_argument, "an obstacle's triangle refers to vertex " +
                                                       std::to_string(index) + " of " +
                                                       std::to_string(mesh.vertices.size()));
        }
      }
    }
  }
}

void check_surroundings(const Surroundings& surroundings) {
  check_obstacles(surroundings.obstacles);
  if (surroundings.support_plane && !std::isfinite(*surroundings.support_plane)) {
    throw Error(ErrorCode::invalid_argument, "the support plane's height is not finite");
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

}  // namespace viewgain::detail
