// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include "convert.hpp"
#include "status.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::c_api {

/// The surroundings of a struct with the fields of vg_scene_config.
template <typename Config>
[[nodiscard]] Surroundings surroundings_of(const Config& config) {
  require_array(config.boxes, config.box_count, "boxes");
  require_array(config.vertices, config.vertex_count, "vertices");
  require_array(config.triangles, config.triangle_count, "triangles");
  Surroundings surroundings{{}, given(config.support_plane)};
  for (std::size_t i = 0; i < config.box_count; ++i) {
    const double* box = config.boxes + 6 * i;
    surroundings.obstacles.boxes.push_back({{box[0], box[1], box[2]}, {box[3], box[4], box[5]}});
  }
  if (config.triangle_count == 0) return surroundings;
  TriangleMesh mesh;
  for (std::size_t i = 0; i < config.vertex_count; ++i) {
    const double* p = config.vertices + 3 * i;
    mesh.vertices.push_back({p[0], p[1], p[2]});
  }
  for (std::size_t i = 0; i < config.triangle_count; ++i) {
    const std::uint32_t* corners = config.triangles + 3 * i;
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  surroundings.obstacles.meshes.push_back(std::move(mesh));
  return surroundings;
}

/// Where a robot can put the camera, as the caller says; null: everywhere.
[[nodiscard]] inline std::function<bool(const Pose&)> predicate_of(
    std::int32_t (*reachable)(const double*, void*), void* user) {
  if (reachable == nullptr) return {};
  return [reachable, user](const Pose& T_world_camera) {
    std::array<double, 16> matrix{};
    write_pose(T_world_camera, matrix.data());
    return reachable(matrix.data(), user) != 0;
  };
}

}  // namespace viewgain::c_api
