// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/map_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "show/pictures/map_cubes.hpp"
#include "show/pictures/ray_tracer.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

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

// A voxel to draw. Sorting brings equal voxels together, the one with the strongest colour first.
struct Cube {
  std::int32_t x, y, z;
  std::size_t kind;  // below ChancePaints::kLevels: unknown, by chance; else one of these
  static constexpr std::size_t kOccupiedHit = ChancePaints::kLevels, kSurface = kOccupiedHit + 1;
  auto operator<=>(const Cube&) const = default;
};

void sort_and_merge(std::vector<Cube>& cubes) {
  std::sort(cubes.begin(), cubes.end());
  cubes.erase(std::unique(cubes.begin(), cubes.end(),
                          [](const Cube& a, const Cube& b) {
                            return a.x == b.x && a.y == b.y && a.z == b.z;
                          }),
              cubes.end());
}

// The occupied voxels and those where the view's rays end or may end. Returns the cubes' side in
// voxels: a map with more voxels than the picture has room for is drawn coarser.
std::int32_t collect_cubes(const GridSnapshot& snapshot,
                           const std::vector<VoxelContribution>& touched,
                           std::vector<Cube>& cubes) {
  for (const VoxelContribution& voxel : touched) {
    const auto kind = voxel.state == VoxelState::unknown ? ChancePaints::level(voxel)
                                                         : std::optional(Cube::kOccupiedHit);
    if (kind) cubes.push_back({voxel.voxel.x, voxel.voxel.y, voxel.voxel.z, *kind});
  }
  for (const Index3& at : occupied_voxels(snapshot)) {
    cubes.push_back({at.x, at.y, at.z, Cube::kSurface});
  }
  sort_and_merge(cubes);
  std::int32_t side = 1;
  for (; cubes.size() > kMaxCubes; side *= 2) {
    for (Cube& cube : cubes) cube = {cube.x >> 1, cube.y >> 1, cube.z >> 1, cube.kind};
    sort_and_merge(cubes);
  }
  return side;
}

}  // namespace

RgbImage map_picture(const GridSnapshot& snapshot, const Viewer& viewer, const ExecConfig& exec) {
  PaintedMesh scene;
  add_map(scene, snapshot);
  const auto corners = workspace_corners(snapshot);
  return rendered(scene, {corners.begin(), corners.end()}, (corners[7] - corners[0]).norm(),
                  viewer.direction(), picture_camera(viewer.width), exec);
}

std::array<double, 2> range_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) return {};
  return {low, high};
}

RgbImage gain_picture(const GridSnapshot& snapshot, const Sensor& sensor,
                      const std::vector<Pose>& poses, const std::vector<double>& gains,
                      const std::array<double, 2>& range, const Viewer& viewer,
                      const ExecConfig& exec) {
  const auto [low, high] = range;
  constexpr double kLength = 0.045, kWidth = 0.004;  // of the workspace's diagonal
  PaintedMesh scene;
  add_map(scene, snapshot);
  const auto corners = workspace_corners(snapshot);
  const Vector3d center = 0.5 * (corners[0] + corners[7]);
  const double extent = (corners[7] - corners[0]).norm();
  const HeatPaints paints(scene, false);
  std::vector<Vector3d> in_sight(corners.begin(), corners.end());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (std::isnan(gains[i]) || !is_rigid(poses[i])) continue;
    const Vector3d eye = poses[i].translation();
    in_sight.push_back(eye);
    const Vector3d offset = eye - center;
    const double toward_viewer = offset.dot(viewer.direction());
    const double aside = (offset - toward_viewer * viewer.direction()).norm();
    if (toward_viewer > 0 && aside < 0.5 * extent) continue;
    add_pyramid(scene, eye, image_corners(sensor, poses[i], kLength * extent), kWidth * extent,
                paints.at(high > low ? (gains[i] - low) / (high - low) : 1));
  }
  return rendered(scene, in_sight, extent, viewer.direction(), picture_camera(viewer.width), exec);
}

RgbImage score_picture(const GainEvaluator& evaluator, const Sensor& sensor,
                       const Pose& T_world_camera, const ExecConfig& exec) {
  if (!is_rigid(T_world_camera)) {
    throw Error(ErrorCode::invalid_argument, "the pose to draw is no rigid transform");
  }
  const GridSnapshot& snapshot = evaluator.scene().snapshot();
  const std::vector<RayHit> hits = evaluator.trace(T_world_camera);
  const auto workspace = workspace_corners(snapshot);
  const double depth = frustum_depth(hits, sensor);
  const auto far_corners = image_corners(sensor, T_world_camera, depth);
  const Vector3d eye = T_world_camera.translation();
  const double extent = (workspace[7] - workspace[0]).norm();

  PaintedMesh scene;
  const ChancePaints unknown_paints(scene);
  const std::uint8_t occupied_paint = scene.add_paint({kOccupiedColor});
  const std::uint8_t surface_paint = scene.add_paint({{0.62, 0.62, 0.60}});
  const std::uint8_t frustum_paint = scene.add_paint({{0.03, 0.04, 0.06}, false});
  const std::uint8_t box_paint = scene.add_paint({{0.45, 0.48, 0.52}, false});

  std::vector<Cube> cubes;
  const std::int32_t side = collect_cubes(snapshot, evaluator.contributions(T_world_camera), cubes);
  const double cube_size = side * snapshot.voxel_size;
  for (const Cube& cube : cubes) {
    add_lattice_cube(scene, snapshot.T_world_grid, Vector3d(cube.x, cube.y, cube.z), cube_size,
                     cube.kind < ChancePaints::kLevels ? unknown_paints[cube.kind]
                     : cube.kind == Cube::kOccupiedHit ? occupied_paint
                                                       : surface_paint);
  }
  add_box_outline(scene, workspace, 0.0012 * extent, box_paint);
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
