// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "support/camel_scene.hpp"

#include <memory>
#include <numbers>

#include "viewgain/core/generators.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;  ///< [rad]

}  // namespace

std::filesystem::path camel_mesh_path() { return VIEWGAIN_CAMEL_MESH; }

TriangleMesh camel_mesh(const std::filesystem::path& path) {
  return read_mesh(path, {.up = UpAxis::z, .center = true, .longest_side = 0.35});
}

std::vector<CamelView> camel_views(std::size_t count, const std::filesystem::path& path) {
  const auto scene = std::make_shared<const SurfaceScene>(camel_mesh(path));
  const SimulatedSensor sensor(scene, sensor_preset("sr4000"), {.background_radius = 1.5});
  std::vector<CamelView> views;
  for (const Pose& pose : orbit_poses(count, 0.6, 27 * kDegree, 0, 46 * kDegree)) {
    views.push_back({pose, sensor.acquire(pose)});
  }
  return views;
}

BeliefGrid empty_camel_grid(int voxels_per_side) {
  return BeliefGrid(
      {.voxel_size = 0.4 / voxels_per_side, .workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}});
}

BeliefGrid camel_grid(int voxels_per_side, const std::vector<CamelView>& views,
                      const IntegrationConfig& config) {
  BeliefGrid grid = empty_camel_grid(voxels_per_side);
  FrameIntegrator integrator(sensor_preset("sr4000"), config);
  for (const CamelView& view : views) integrator.integrate(grid, view.frame, view.T_world_camera);
  return grid;
}

BeliefGrid camel_grid(int voxels_per_side, const std::filesystem::path& path) {
  return camel_grid(voxels_per_side, camel_views(3, path));
}

}  // namespace viewgain::test
