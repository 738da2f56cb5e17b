// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "png_io.hpp"
#include "ray_tracer.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = 1280, kHeight = 960;  // [px]
constexpr double kFocal = 1700;              // [px]; a long lens, so that near cubes are not huge
constexpr double kMargin = 0.06;             // of the picture's sides that stay empty
constexpr std::size_t kMaxCubes = 400'000;

struct Bounds {
  Vector3d min = Vector3d::Constant(1e300), max = Vector3d::Constant(-1e300);

  void add(const Vector3d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

// A voxel to draw. Sorting brings equal voxels together, the one with the strongest colour first.
struct Cube {
  enum class Kind : std::uint8_t { unknown_hit, occupied_hit, surface };
  std::int32_t x, y, z;
  Kind kind;
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

// The occupied voxels and those where the view's rays end. Returns the cubes' side in voxels: a map
// with more voxels than the picture has room for is drawn coarser.
std::int32_t collect_cubes(const GridSnapshot& snapshot, const std::vector<RayHit>& hits,
                           std::vector<Cube>& cubes) {
  for (const RayHit& hit : hits) {
    if (hit.kind == RayHit::Kind::unknown) {
      cubes.push_back({hit.voxel.x, hit.voxel.y, hit.voxel.z, Cube::Kind::unknown_hit});
    } else if (hit.kind == RayHit::Kind::occupied) {
      cubes.push_back({hit.voxel.x, hit.voxel.y, hit.voxel.z, Cube::Kind::occupied_hit});
    }
  }
  for (const SnapshotLeaf& leaf : snapshot.leaves) {
    for (unsigned offset = 0; offset < 512; ++offset) {
      if (!test_bit(leaf.occupied, offset)) continue;
      cubes.push_back({leaf.origin.x + static_cast<std::int32_t>(offset >> 6U),
                       leaf.origin.y + static_cast<std::int32_t>(offset >> 3U & 7U),
                       leaf.origin.z + static_cast<std::int32_t>(offset & 7U),
                       Cube::Kind::surface});
    }
  }
  sort_and_merge(cubes);
  std::int32_t side = 1;
  for (; cubes.size() > kMaxCubes; side *= 2) {
    for (Cube& cube : cubes) cube = {cube.x >> 1, cube.y >> 1, cube.z >> 1, cube.kind};
    sort_and_merge(cubes);
  }
  return side;
}

// The corners of the box [low, high] of the grid's frame, in the world.
std::array<Vector3d, 8> box_corners(const Pose& T_world_grid, const Vector3d& low,
                                    const Vector3d& high) {
  std::array<Vector3d, 8> corners;
  for (unsigned k = 0; k < 8; ++k) {
    corners[k] = T_world_grid * Vector3d((k & 1U) != 0 ? high.x() : low.x(),
                                         (k & 2U) != 0 ? high.y() : low.y(),
                                         (k & 4U) != 0 ? high.z() : low.z());
  }
  return corners;
}

std::array<Vector3d, 8> workspace_corners(const GridSnapshot& s) {
  const Vector3d low(s.min_index.x, s.min_index.y, s.min_index.z);
  const Vector3d size(s.dims.x, s.dims.y, s.dims.z);
  return box_corners(s.T_world_grid, s.voxel_size * low, s.voxel_size * (low + size));
}

void add_box_outline(PaintedMesh& scene, const std::array<Vector3d, 8>& corners, double width,
                     std::uint8_t paint) {
  for (unsigned a = 0; a < 8; ++a) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((a & axis) == 0) scene.add_line(corners[a], corners[a | axis], width, paint);
    }
  }
}

// The four corners of the image at this depth [m], in the world.
std::array<Vector3d, 4> image_corners(const Sensor& sensor, const Pose& T_world_camera,
                                      double depth) {
  const double u = sensor.camera.width - 0.5, v = sensor.camera.height - 0.5;
  std::array<Vector3d, 4> corners{sensor.camera.ray(-0.5, -0.5), sensor.camera.ray(u, -0.5),
                                  sensor.camera.ray(u, v), sensor.camera.ray(-0.5, v)};
  for (Vector3d& p : corners) p = T_world_camera * Vector3d(depth * p);
  return corners;
}

void add_pyramid(PaintedMesh& scene, const Vector3d& apex, const std::array<Vector3d, 4>& base,
                 double width, std::uint8_t paint) {
  for (std::size_t k = 0; k < 4; ++k) {
    scene.add_line(apex, base[k], width, paint);
    scene.add_line(base[k], base[(k + 1) % 4], width, paint);
  }
}

// How far the frustum is drawn: to the middle of what the view sees, or its working distance.
double frustum_depth(const std::vector<RayHit>& hits, const Sensor& sensor) {
  std::vector<double> ranges;
  for (const RayHit& hit : hits) {
    if (hit.kind != RayHit::Kind::none) ranges.push_back(hit.range);
  }
  if (ranges.empty()) return sensor.working_distance;
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

// Looks at all `points` from the side of the view's optical axis and a little from above, so that
// what the view sees and the way to it are both in sight. Moves the principal point to centre them.
Pose place_viewer(const std::vector<Vector3d>& points, const Vector3d& view_eye,
                  const Vector3d& view_target, PinholeCamera& camera) {
  constexpr double kAside = 58 * std::numbers::pi / 180, kAbove = 24 * std::numbers::pi / 180;
  Vector3d back = view_eye - view_target;
  back.z() = 0;
  if (back.norm() < 1e-6 * (1 + view_eye.norm())) back = Vector3d::UnitX();
  const Vector3d level = Eigen::AngleAxisd(kAside, Vector3d::UnitZ()) * Vector3d(back.normalized());
  const Vector3d direction = std::cos(kAbove) * level + std::sin(kAbove) * Vector3d::UnitZ();

  Bounds bounds;
  for (const Vector3d& p : points) bounds.add(p);
  const Vector3d center = 0.5 * (bounds.min + bounds.max);
  const double radius = 0.5 * (bounds.max - bounds.min).norm();
  Pose T_world_camera;
  for (double distance = 1.2 * radius;; distance *= 1.02) {
    T_world_camera = look_at(center + distance * direction, center);
    const Pose T_camera_world = T_world_camera.inverse();
    Bounds pixels;
    bool in_front = true;
    for (const Vector3d& p : points) {
      const Vector3d q = T_camera_world * p;
      in_front = in_front && q.z() > 0.05 * radius;
      pixels.add({camera.fx * q.x() / q.z(), camera.fy * q.y() / q.z(), 0});
    }
    const Vector3d size = pixels.max - pixels.min;
    if (in_front && size.x() <= (1 - 2 * kMargin) * kWidth &&
        size.y() <= (1 - 2 * kMargin) * kHeight) {
      camera.cx = 0.5 * kWidth - 0.5 * (pixels.min.x() + pixels.max.x());
      camera.cy = 0.5 * kHeight - 0.5 * (pixels.min.y() + pixels.max.y());
      return T_world_camera;
    }
  }
}

}  // namespace

void write_picture(const std::filesystem::path& path, const GainEvaluator& evaluator,
                   const Sensor& sensor, const Pose& T_world_camera, const ExecConfig& exec) {
  if (!(orthonormality_error(T_world_camera) < 1e-3)) {
    throw Error(ErrorCode::invalid_argument,
                path.string() + ": the best pose is no rigid transform");
  }
  const GridSnapshot& snapshot = evaluator.scene().snapshot();
  const std::vector<RayHit> hits = evaluator.trace(T_world_camera);
  const auto workspace = workspace_corners(snapshot);
  const double depth = frustum_depth(hits, sensor);
  const auto far_corners = image_corners(sensor, T_world_camera, depth);
  const Vector3d eye = T_world_camera.translation();
  const double extent = (workspace[7] - workspace[0]).norm();

  PaintedMesh scene;
  const std::array<std::uint8_t, 3> cube_paints{
      scene.add_paint({{0.95, 0.30, 0.03}}),   // unknown_hit: orange
      scene.add_paint({{0.05, 0.26, 0.85}}),   // occupied_hit: blue
      scene.add_paint({{0.62, 0.62, 0.60}})};  // surface: grey
  const std::uint8_t frustum_paint = scene.add_paint({{0.03, 0.04, 0.06}, false});
  const std::uint8_t box_paint = scene.add_paint({{0.45, 0.48, 0.52}, false});

  std::vector<Cube> cubes;
  const std::int32_t side = collect_cubes(snapshot, hits, cubes);
  const double cube_size = side * snapshot.voxel_size;
  constexpr double kGap = 0.04;  // of a cube, on each side: makes single voxels visible
  for (const Cube& cube : cubes) {
    const Vector3d low(cube.x, cube.y, cube.z);
    scene.add_hexahedron(
        box_corners(snapshot.T_world_grid, cube_size * (low + Vector3d::Constant(kGap)),
                    cube_size * (low + Vector3d::Constant(1 - kGap))),
        cube_paints[static_cast<std::size_t>(cube.kind)]);
  }
  add_box_outline(scene, workspace, 0.0012 * extent, box_paint);
  add_pyramid(scene, eye, far_corners, 0.0025 * extent, frustum_paint);
  add_pyramid(scene, eye, image_corners(sensor, T_world_camera, 0.12 * depth), 0.007 * extent,
              frustum_paint);

  std::vector<Vector3d> in_sight(workspace.begin(), workspace.end());
  in_sight.push_back(eye);
  in_sight.insert(in_sight.end(), far_corners.begin(), far_corners.end());
  PinholeCamera camera{kWidth, kHeight, kFocal, kFocal, 0.5 * kWidth, 0.5 * kHeight, {}};
  const Vector3d target = T_world_camera * Vector3d(0, 0, depth);
  const Pose T_world_viewer = place_viewer(in_sight, eye, target, camera);
  write_png(path, render(scene, camera, T_world_viewer, 0.12 * extent, exec));
}

}  // namespace viewgain::app
