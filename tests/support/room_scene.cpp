// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "support/room_scene.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain::test {
namespace {

constexpr double kWall = 0.2;  // of the workspace behind the walls [m]
const Box kRoom{{-2.5, -2.0, 0.0}, {2.5, 2.0, 2.6}};
// Table, cupboard, shelf, bed, chair, a crate on the table, a lamp, a beam.
const std::vector<Box> kFurniture{
    {{-0.4, 1.0, 0.68}, {1.0, 1.8, 0.74}},   {{-2.5, -1.9, 0.0}, {-1.9, -0.7, 2.0}},
    {{1.2, -2.0, 1.2}, {2.3, -1.7, 1.25}},   {{1.0, 0.2, 0.0}, {2.5, 1.6, 0.5}},
    {{-0.3, 0.5, 0.0}, {0.15, 0.9, 0.46}},   {{0.4, 1.2, 0.74}, {0.75, 1.5, 0.98}},
    {{-1.5, 1.55, 0.0}, {-1.42, 1.63, 1.7}}, {{-2.5, -0.1, 2.4}, {2.5, 0.1, 2.6}}};

}  // namespace

void add_box(TriangleMesh& mesh, const Box& box) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1U ? box.max : box.min)[0],
                             (corner & 2U ? box.max : box.min)[1],
                             (corner & 4U ? box.max : box.min)[2]});
  }
  for (const auto& face :
       {std::array{0U, 1U, 3U, 2U}, std::array{4U, 6U, 7U, 5U}, std::array{0U, 4U, 5U, 1U},
        std::array{2U, 3U, 7U, 6U}, std::array{0U, 2U, 6U, 4U}, std::array{1U, 5U, 7U, 3U}}) {
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
    mesh.triangles.push_back({first + face[0], first + face[2], first + face[3]});
  }
}

BeliefGrid room_grid(double voxel_size, const Sensor& sensor, int frames, const ExecConfig& exec) {
  TriangleMesh mesh;
  add_box(mesh, kRoom);
  for (const Box& box : kFurniture) add_box(mesh, box);
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(std::move(mesh), exec), sensor,
                               {.noise = true}, exec);
  Box workspace = kRoom;
  for (std::size_t k = 0; k < 3; ++k) workspace.min[k] -= kWall, workspace.max[k] += kWall;
  BeliefGrid grid({.voxel_size = voxel_size, .workspace = workspace}, sensor);
  FrameIntegrator integrator(sensor, {}, exec);
  for (int i = 0; i < frames; ++i) {
    const double turn = std::numbers::pi * i / frames;
    const Eigen::Vector3d eye(-0.5 + 0.8 * turn / std::numbers::pi, -0.6, 1.5);
    const Eigen::Vector3d ahead(std::cos(turn), std::sin(turn), -0.25 + 0.2 * std::cos(3 * turn));
    const Pose pose = look_at(eye, eye + ahead);
    integrator.integrate(grid, camera.acquire(pose, static_cast<std::uint64_t>(i)), pose);
  }
  return grid;
}

std::vector<Pose> poses_in(const GridSnapshot& map, std::size_t count, std::uint64_t seed) {
  std::uint64_t drawn = 0;
  const auto unit = [&] { return unit_number(mix64(mix64(seed) + drawn++)); };
  const double V = map.voxel_size;
  std::vector<Pose> poses;
  while (poses.size() < count) {
    const Eigen::Vector3d at(V * (map.min_index.x + map.dims.x * unit()),
                             V * (map.min_index.y + map.dims.y * unit()),
                             V * (map.min_index.z + map.dims.z * unit()));
    const double turn = 2 * std::numbers::pi * unit(), rise = 1.6 * unit() - 0.8;
    const Eigen::Vector3d eye = map.T_world_grid * at;
    const auto voxel = map.index_of(eye);
    if (!voxel || (poses.size() % 2 == 0 && !map.is_free(*voxel))) continue;
    poses.push_back(look_at(eye, eye + Eigen::Vector3d(std::cos(turn), std::sin(turn), rise)));
  }
  return poses;
}

}  // namespace viewgain::test
