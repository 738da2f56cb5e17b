// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/map_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "show/pictures/map_cubes.hpp"
#include "show/pictures/ray_tracer.hpp"

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
                  const Viewer& viewer, const ExecConfig& exec) {
  PinholeCamera camera = picture_camera(viewer.width);
  const Pose T_world_viewer = place_viewer(in_sight, viewer.direction(), camera);
  return render(scene, camera, T_world_viewer, 0.12 * extent, exec);
}

}  // namespace

RgbImage map_picture(const GridSnapshot& snapshot, const Viewer& viewer, const ExecConfig& exec) {
  PaintedMesh scene;
  add_map(scene, snapshot);
  const auto corners = workspace_corners(snapshot);
  return rendered(scene, {corners.begin(), corners.end()}, (corners[7] - corners[0]).norm(), viewer,
                  exec);
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
  return rendered(scene, in_sight, extent, viewer, exec);
}

}  // namespace viewgain::app
