// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A planner on octomap::OcTree whose gain is viewgain's, whose map follows the tree as it grows.
//
//   octomap_planner [VIEWS]        exit codes: 0, 2 for bad input
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>
#include <viewgain/formats/octomap_tree.hpp>
#include <viewgain/viewgain.hpp>

namespace {

using Eigen::Vector3d;
using viewgain::Pose;

constexpr double kVoxel = 0.02;                                          // [m]
const viewgain::Box kMapped{{-0.96, -0.96, -0.96}, {0.96, 0.96, 0.96}};  // holds all of the room

octomap::point3d point(const Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

// The real thing, simulated: a box in the middle of a round room.
viewgain::SimulatedSensor make_camera(const viewgain::Sensor& sensor) {
  const viewgain::Obstacles box{{{{-0.15, -0.1, -0.2}, {0.15, 0.1, 0.2}}}, {}};
  return {std::make_shared<viewgain::SurfaceScene>(viewgain::mesh_of(box)),
          sensor,
          {.background_radius = 0.9}};
}

void take_view(const viewgain::SimulatedSensor& camera, const std::vector<Vector3d>& rays,
               const Pose& view, octomap::OcTree& tree) {
  const viewgain::DepthFrame frame = camera.acquire(view);
  octomap::Pointcloud cloud;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto depth = static_cast<double>(frame.depth[i]);
    if (depth > 0 && std::isfinite(depth)) cloud.push_back(point(view * (rays[i] * depth)));
  }
  tree.insertPointCloud(cloud, point(view.translation()));
}

}  // namespace

int main(int argc, char** argv) {
  const int views = argc > 1 ? std::atoi(argv[1]) : 3;
  if (argc > 2 || views < 1) {
    std::fprintf(stderr, "usage: octomap_planner [VIEWS], a whole number from 1 on\n");
    return 2;
  }
  const viewgain::Sensor sensor = viewgain::sensor_preset("sr4000");
  const viewgain::SimulatedSensor camera = make_camera(sensor);
  const std::vector<Vector3d> rays = sensor.camera.ray_table();
  octomap::OcTree tree(kVoxel);
  viewgain::BeliefGrid grid({.voxel_size = kVoxel, .workspace = kMapped}, sensor);
  auto scene = viewgain::VoxelScene::build(grid);
  viewgain::GainEvaluator evaluator(scene, sensor, {.model = viewgain::GainModel::surface});
  Pose next = viewgain::look_at({0.6, 0.05, 0.1}, {0, 0, 0});
  for (int i = 0; i < views; ++i) {
    take_view(camera, rays, next, tree);
    const auto changed = viewgain::update_from_octree(grid, tree, kMapped);
    scene = viewgain::VoxelScene::update(scene, grid);
    evaluator = evaluator.with_scene(scene);
    std::vector<Pose> candidates = viewgain::sphere_poses(500, 0.55);
    std::erase_if(candidates, [&](const Pose& view) {  // the camera stays in known free space
      const auto* node = tree.search(point(view.translation()));
      return node == nullptr || tree.isNodeOccupied(node);
    });
    if (candidates.empty()) break;
    const auto gains = evaluator.evaluate(candidates);
    const std::size_t best = viewgain::best_indices(gains, 1).front();
    next = candidates[best];
    std::printf("view %d: %zu voxels changed, %zu candidates, the best may show %.4f m2\n", i + 1,
                static_cast<std::size_t>(changed), candidates.size(), gains[best].gain);
  }
  return 0;
}
