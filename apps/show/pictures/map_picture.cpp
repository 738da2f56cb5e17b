// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/map_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <tuple>

#include "show/pictures/ray_tracer.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

// Leaf by leaf.
std::vector<Index3> occupied_voxels(const GridSnapshot& snapshot) {
  std::vector<Index3> voxels;
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    for (unsigned offset = 0; offset < 512; ++offset) {
      if (!test_bit(leaf.occupied, offset)) continue;
      voxels.push_back({leaf.origin.x + static_cast<std::int32_t>(offset >> 6U),
                        leaf.origin.y + static_cast<std::int32_t>(offset >> 3U & 7U),
                        leaf.origin.z + static_cast<std::int32_t>(offset & 7U)});
    }
  }
  return voxels;
}

using Eigen::Vector3d;

void add_map(PaintedMesh& scene, const GridSnapshot& snapshot) {
  const std::uint8_t surface_paint = scene.add_paint({{0.62, 0.62, 0.60}});
  const std::uint8_t box_paint = scene.add_paint({{0.45, 0.48, 0.52}, false});
  const LatticeCubes cubes = occupied_cubes(snapshot, kMaxCubes);
  for (const Index3& at : cubes.at) {
    add_lattice_cube(scene, snapshot.T_world_grid, Vector3d(at.x, at.y, at.z), cubes.side,
                     surface_paint);
  }
  const auto corners = workspace_corners(snapshot);
  add_box_outline(scene, corners, 0.0012 * (corners[7] - corners[0]).norm(), box_paint);
}

RgbImage rendered(const PaintedMesh& scene, const std::vector<Vector3d>& in_sight, double extent,
                  const Vector3d& direction, PinholeCamera camera, const ExecConfig& exec) {
  const Pose T_world_viewer = place_viewer(in_sight, direction, camera);
  return render(scene, camera, T_world_viewer, 0.12 * extent, exec);
}

}  // namespace

LatticeCubes occupied_cubes(const GridSnapshot& snapshot, std::size_t most) {
  LatticeCubes cubes{occupied_voxels(snapshot), snapshot.voxel_size};
  const auto sort_and_merge = [&] {
    std::sort(cubes.at.begin(), cubes.at.end(), [](const Index3& a, const Index3& b) {
      return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    cubes.at.erase(std::unique(cubes.at.begin(), cubes.at.end()), cubes.at.end());
  };
  sort_and_merge();
  for (; cubes.at.size() > most; cubes.side *= 2) {
    for (Index3& at : cubes.at) at = {at.x >> 1, at.y >> 1, at.z >> 1};
    sort_and_merge();
  }
  return cubes;
}

RgbImage map_picture(const GridSnapshot& snapshot, const Viewer& viewer, const ExecConfig& exec) {
  PaintedMesh scene;
  add_map(scene, snapshot);
  const auto corners = workspace_corners(snapshot);
  return rendered(scene, {corners.begin(), corners.end()}, (corners[7] - corners[0]).norm(),
                  viewer.direction(), picture_camera(viewer.width), exec);
}

RgbImage score_picture(const GainEvaluator& evaluator, const Sensor& sensor,
                       const Pose& T_world_camera, const ExecConfig& exec) {
  if (!is_rigid(T_world_camera)) refuse("the pose to draw is not a rigid transform");
  const GridSnapshot& snapshot = evaluator.scene().snapshot();
  const std::vector<RayHit> hits = evaluator.trace(T_world_camera);
  const auto workspace = workspace_corners(snapshot);
  const double depth = frustum_depth(hits, sensor);
  const auto far_corners = image_corners(sensor, T_world_camera, depth);
  const Vector3d eye = T_world_camera.translation();
  const double extent = (workspace[7] - workspace[0]).norm();

  PaintedMesh scene;
  add_map(scene, snapshot);
  const VoxelPaints paints(scene);
  for (const VoxelContribution& voxel : evaluator.contributions(T_world_camera)) {
    paints.add(scene, snapshot, voxel);
  }
  const std::uint8_t frustum_paint = scene.add_paint({{0.03, 0.04, 0.06}, false});
  add_pyramid(scene, eye, far_corners, 0.0025 * extent, frustum_paint);
  add_pyramid(scene, eye, image_corners(sensor, T_world_camera, 0.12 * depth), 0.007 * extent,
              frustum_paint);

  std::vector<Vector3d> in_sight(workspace.begin(), workspace.end());
  in_sight.push_back(eye);
  in_sight.insert(in_sight.end(), far_corners.begin(), far_corners.end());
  const Vector3d target = T_world_camera * Vector3d(0, 0, depth);
  return rendered(scene, in_sight, extent, viewer_beside(eye, target, Side::counter_clockwise),
                  picture_camera(), exec);
}

}  // namespace viewgain::app
