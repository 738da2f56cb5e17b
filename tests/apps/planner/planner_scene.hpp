// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>

#include "support/meshes.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::test {

/// Adds a rectangle that looks up, at height z, from (-x, -y) to (x, y) [m].
inline void add_plate(TriangleMesh& mesh, double x, double y, double z) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [sx, sy] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    mesh.vertices.push_back({sx * x, sy * y, z});
  }
  mesh.triangles.push_back({base, base + 1, base + 2});
  mesh.triangles.push_back({base, base + 2, base + 3});
}

/// An SR4000 at half its resolution.
inline Sensor half_sr4000() {
  Sensor sensor = sensor_preset("sr4000");
  PinholeCamera& c = sensor.camera;
  c.width /= 2, c.height /= 2, c.fx /= 2, c.fy /= 2;
  c.cx = 0.5 * (c.width - 1), c.cy = 0.5 * (c.height - 1);
  return sensor;
}

inline SurfaceModelConfig model_config(const Sensor& sensor, double half_workspace, double voxel) {
  SurfaceModelConfig model;
  ScorerConfig& map = model.map;
  map.voxel_size = voxel;
  map.workspace.min.fill(-half_workspace);
  map.workspace.max.fill(half_workspace);
  map.prior_sigma = default_prior_sigma(voxel, sensor);
  return model;
}

}  // namespace viewgain::test
