// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/picture_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

constexpr double kMargin = 0.06;  // of the picture's sides that stay empty

struct Bounds {
  Vector3d min = Vector3d::Constant(1e300), max = Vector3d::Constant(-1e300);

  void add(const Vector3d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

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

}  // namespace

PinholeCamera picture_camera(int width) {
  const int height = width / 4 * 3;
  const double focal = 1700.0 / 1280 * width;
  return {width, height, focal, focal, 0.5 * width, 0.5 * height, {}};
}

Vector3d Viewer::direction() const {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

HeatPaints::HeatPaints(PaintedMesh& scene) {
  // Violet, blue, teal, green, yellow: lightness rises evenly.
  static const std::array<Vector3d, 5> kAnchors{{{0.058, 0.0, 0.089},
                                                 {0.044, 0.084, 0.258},
                                                 {0.015, 0.283, 0.263},
                                                 {0.112, 0.584, 0.124},
                                                 {0.983, 0.799, 0.019}}};
  for (std::size_t k = 0; k < paints_.size(); ++k) {
    const double at = 4.0 * static_cast<double>(k) / static_cast<double>(paints_.size() - 1);
    const auto below = std::min<std::size_t>(3, static_cast<std::size_t>(at));
    const double share = at - static_cast<double>(below);
    paints_[k] = scene.add_paint(
        {.color = (1 - share) * kAnchors[below] + share * kAnchors[below + 1], .back_side = 0.55});
  }
}

std::uint8_t HeatPaints::at(double share) const {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(paints_.size() - 1);
  return paints_[static_cast<std::size_t>(std::lround(place))];
}

bool is_rigid(const Pose& pose) { return rigid_pose(pose).has_value(); }

std::array<Vector3d, 8> workspace_corners(const GridSnapshot& snapshot) {
  const Vector3d low(snapshot.min_index.x, snapshot.min_index.y, snapshot.min_index.z);
  const Vector3d size(snapshot.dims.x, snapshot.dims.y, snapshot.dims.z);
  return box_corners(snapshot.T_world_grid, snapshot.voxel_size * low,
                     snapshot.voxel_size * (low + size));
}

void add_box_outline(PaintedMesh& scene, const std::array<Vector3d, 8>& corners, double width,
                     std::uint8_t paint) {
  for (unsigned a = 0; a < 8; ++a) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((a & axis) == 0) scene.add_line(corners[a], corners[a | axis], width, paint);
    }
  }
}

void add_lattice_cube(PaintedMesh& scene, const Pose& T_world_grid, const Vector3d& index,
                      double side, std::uint8_t paint, double share) {
  const Vector3d low = index + Vector3d::Constant(0.5 - 0.5 * share);
  scene.add_hexahedron(
      box_corners(T_world_grid, side * low, side * (low + Vector3d::Constant(share))), paint);
}

VoxelPaints::VoxelPaints(PaintedMesh& scene)
    : unknown_(scene.add_paint({.color = kUnknownColor, .passes_light = true})),
      occupied_(scene.add_paint({.color = kOccupiedColor, .passes_light = true})) {}

void VoxelPaints::add(PaintedMesh& scene, const GridSnapshot& snapshot, Index3 voxel,
                      bool is_unknown, double share) const {
  add_lattice_cube(scene, snapshot.T_world_grid, Vector3d(voxel.x, voxel.y, voxel.z),
                   snapshot.voxel_size, is_unknown ? unknown_ : occupied_, share);
}

void VoxelPaints::add(PaintedMesh& scene, const GridSnapshot& snapshot,
                      const VoxelContribution& voxel) const {
  constexpr double kLeast = 0.01, kWhole = 0.5;
  if (voxel.state != VoxelState::unknown) return add(scene, snapshot, voxel.voxel, false);
  const double chance = voxel.expected_rays / std::max(1U, voxel.rays);
  if (chance < kLeast) return;
  add(scene, snapshot, voxel.voxel, true, std::sqrt(std::min(1.0, chance / kWhole)));
}

std::array<Vector3d, 4> image_corners(const Sensor& sensor, const Pose& T_world_camera,
                                      double depth) {
  const double u = sensor.camera.width - 0.5, v = sensor.camera.height - 0.5;
  // As drawn, without distortion, which may fold beyond the last pixel's centre.
  PinholeCamera camera = sensor.camera;
  camera.distortion = {};
  std::array<Vector3d, 4> corners{camera.ray(-0.5, -0.5), camera.ray(u, -0.5), camera.ray(u, v),
                                  camera.ray(-0.5, v)};
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

std::vector<RayHit> even_hits(const std::vector<RayHit>& hits, const PinholeCamera& camera,
                              std::size_t most) {
  if (hits.empty()) return {};
  const auto strided = [](int size, std::size_t s) {
    return (static_cast<std::size_t>(size) + s - 1) / s;
  };
  std::size_t stride = 1;
  while (strided(camera.width, stride) * strided(camera.height, stride) > hits.size()) ++stride;
  const std::size_t columns = strided(camera.width, stride), rows = strided(camera.height, stride);
  for (std::size_t n = 1;; ++n) {
    std::vector<RayHit> shown;
    for (std::size_t v = n / 2; v < rows; v += n) {
      for (std::size_t u = n / 2; u < columns; u += n) {
        const RayHit& hit = hits[v * columns + u];
        if (hit.kind == RayHit::Kind::unknown || hit.kind == RayHit::Kind::occupied) {
          shown.push_back(hit);
        }
      }
    }
    if (shown.size() <= most) return shown;
  }
}

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

Vector3d viewer_azimuth(const Vector3d& view_eye, const Vector3d& view_target, Side side) {
  constexpr double kAside = 58 * std::numbers::pi / 180;
  Vector3d back = view_eye - view_target;
  back.z() = 0;
  if (back.norm() < 1e-6 * (1 + view_eye.norm())) back = Vector3d::UnitX();
  const double angle = side == Side::counter_clockwise ? kAside : -kAside;
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * Vector3d(back.normalized());
}

Vector3d viewer_beside(const Vector3d& view_eye, const Vector3d& view_target, Side side) {
  constexpr double kAbove = 24 * std::numbers::pi / 180;
  return std::cos(kAbove) * viewer_azimuth(view_eye, view_target, side) +
         std::sin(kAbove) * Vector3d::UnitZ();
}

Pose place_viewer(const std::vector<Vector3d>& points, const Vector3d& direction,
                  PinholeCamera& camera) {
  constexpr double kWidest = 1e6;  // [m]; the tracer's numbers have seven digits
  Bounds bounds;
  for (const Vector3d& p : points) {
    bounds.add(p);
    if (!p.allFinite() || !((bounds.max - bounds.min).maxCoeff() < kWidest)) {
      refuse("a picture cannot show both a point at " + short_text(p.x()) + ", " +
             short_text(p.y()) + ", " + short_text(p.z()) + " m and a point that is " +
             "1000 km away");
    }
  }
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
    if (in_front && size.x() <= (1 - 2 * kMargin) * camera.width &&
        size.y() <= (1 - 2 * kMargin) * camera.height) {
      camera.cx = 0.5 * camera.width - 0.5 * (pixels.min.x() + pixels.max.x());
      camera.cy = 0.5 * camera.height - 0.5 * (pixels.min.y() + pixels.max.y());
      return T_world_camera;
    }
  }
}

}  // namespace viewgain::app
