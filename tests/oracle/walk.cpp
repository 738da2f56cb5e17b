// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oracle/walk.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace viewgain::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kRing = 16;  ///< directions in which is_tie() moves a ray

/// Part of a ray, t in [begin, end); empty if begin >= end.
struct Interval {
  double begin = 0;
  double end = kInfinity;
};

/// Where along t >= 0 the ray is inside a box. An axis the ray does not move along is half-open.
Interval clip(const Ray& ray, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  Interval inside;
  for (int k = 0; k < 3; ++k) {
    const double o = ray.origin[k];
    const double d = ray.direction[k];
    if (d == 0) {
      if (o < lower[k] || o >= upper[k]) return {0, 0};
      continue;
    }
    inside.begin = std::max(inside.begin, ((d > 0 ? lower[k] : upper[k]) - o) / d);
    inside.end = std::min(inside.end, ((d > 0 ? upper[k] : lower[k]) - o) / d);
  }
  return inside;
}

Eigen::Vector3d corner(Index3 voxel, double shift) {
  return Eigen::Vector3d(voxel.x, voxel.y, voxel.z) + Eigen::Vector3d::Constant(shift);
}

/// One axis of the walk. Plane times are computed from the plane each time, never added up, so they
/// are monotone in the plane's index and equal for axes that tie.
struct Axis {
  double origin = 0;
  double direction = 0;
  std::int64_t cell = 0;

  [[nodiscard]] double time(std::int64_t plane) const {
    return (static_cast<double>(plane) - origin) / direction;
  }
  [[nodiscard]] double entry() const {
    return direction == 0 ? -kInfinity : time(direction > 0 ? cell : cell + 1);
  }
  [[nodiscard]] double exit() const {
    return direction == 0 ? kInfinity : time(direction > 0 ? cell + 1 : cell);
  }
  void advance() { cell += direction > 0 ? 1 : -1; }

  /// The cell that holds the ray just after t.
  void locate(double t) {
    cell = static_cast<std::int64_t>(std::floor(direction == 0 ? origin : origin + direction * t));
    if (direction == 0) return;
    while (exit() <= t) advance();
    while (entry() > t) cell -= direction > 0 ? 1 : -1;
  }
};

bool usable(const Ray& ray) { return ray.origin.allFinite() && ray.direction.allFinite(); }

Index3 upper_index(const DenseMap& map) {
  return {map.min_index.x + map.dims.x, map.min_index.y + map.dims.y, map.min_index.z + map.dims.z};
}

RayHit::Kind kind_of(VoxelState state) {
  return state == VoxelState::occupied ? RayHit::Kind::occupied : RayHit::Kind::unknown;
}

bool is_voxel(RayHit::Kind kind) {
  return kind == RayHit::Kind::unknown || kind == RayHit::Kind::occupied;
}

/// first_hit(), with visits of at most `shortest` voxels taken for none.
RayHit first_visit(const DenseMap& map, const Ray& ray, const RayLimits& limits, double shortest) {
  RayHit hit;
  walk(map, ray, [&](Index3 voxel, double t_in, double t_out) {
    if (t_in > limits.max_range) return true;
    const VoxelState state = map.state(voxel);
    if (t_out - t_in > shortest && blocks(map, ray, limits, voxel, t_in)) {
      hit = {RayHit::Kind::obstacle, {}, t_in};
      return true;
    }
    if (state == VoxelState::free || t_out <= limits.min_range || t_out - t_in <= shortest) {
      return false;
    }
    hit = {kind_of(state), voxel, std::max(t_in, limits.min_range)};
    return true;
  });
  if (limits.obstacle_range < hit.range) {
    hit = {RayHit::Kind::obstacle, {}, limits.obstacle_range};
  }
  hit.range *= map.voxel_size;
  return hit;
}

}  // namespace

void walk(const DenseMap& map, const Ray& ray,
          const std::function<bool(Index3, double, double)>& visit) {
  if (!usable(ray)) return;
  const Interval inside = clip(ray, corner(map.min_index, 0), corner(upper_index(map), 0));
  if (!(inside.begin < inside.end)) return;

  std::array<Axis, 3> axes;
  for (std::size_t k = 0; k < 3; ++k) {
    axes[k].origin = ray.origin[static_cast<Eigen::Index>(k)];
    axes[k].direction = ray.direction[static_cast<Eigen::Index>(k)];
    axes[k].locate(inside.begin);
  }
  double t = inside.begin;
  while (true) {
    const double t_out = std::min({axes[0].exit(), axes[1].exit(), axes[2].exit()});
    const Index3 voxel{static_cast<std::int32_t>(axes[0].cell),
                       static_cast<std::int32_t>(axes[1].cell),
                       static_cast<std::int32_t>(axes[2].cell)};
    if (!map.inside(voxel)) return;
    if (t_out > t && visit(voxel, t, t_out)) return;
    if (t_out == kInfinity) return;
    for (Axis& axis : axes) {
      if (axis.exit() == t_out) axis.advance();
    }
    t = t_out;
  }
}

bool blocks(const DenseMap& map, const Ray& ray, const RayLimits& limits, Index3 voxel, double t) {
  if (map.state(voxel) != VoxelState::occupied || !(t < limits.min_range)) return false;
  const Eigen::Vector3d& eye = ray.origin;
  return voxel != Index3{static_cast<std::int32_t>(std::floor(eye.x())),
                         static_cast<std::int32_t>(std::floor(eye.y())),
                         static_cast<std::int32_t>(std::floor(eye.z()))};
}

RayHit first_hit(const DenseMap& map, const Ray& ray, const RayLimits& limits) {
  return first_visit(map, ray, limits, 0);
}

bool is_tie(const DenseMap& map, const Ray& ray, const RayLimits& limits, const RayHit& tested,
            double tolerance) {
  if (!usable(ray)) return tested.kind == RayHit::Kind::none;
  const Eigen::Vector3d across = ray.direction.unitOrthogonal();
  const Eigen::Vector3d up = ray.direction.cross(across);
  for (const double shift_min : {0.0, -tolerance, tolerance}) {
    for (const double shift_max : {0.0, -tolerance, tolerance}) {
      RayLimits moved_limits = limits;
      moved_limits.min_range = std::max(0.0, limits.min_range + shift_min);
      moved_limits.max_range += shift_max;
      const auto ends_there = [&](const Ray& moved) {
        return same_ending(first_visit(map, moved, moved_limits, 0), tested) ||
               same_ending(first_visit(map, moved, moved_limits, tolerance), tested);
      };
      if (ends_there(ray)) return true;
      for (const double share : {1.0, 0.3, 0.1, 0.03, 0.01, 0.001}) {
        for (int i = 0; i < kRing; ++i) {
          const double angle = 2 * std::numbers::pi * i / kRing;
          Ray moved = ray;
          moved.origin += share * tolerance * (std::cos(angle) * across + std::sin(angle) * up);
          if (ends_there(moved)) return true;
        }
      }
    }
  }
  return false;
}

bool range_is_entry(const DenseMap& map, const Ray& ray, const RayLimits& limits,
                    const RayHit& tested, double tolerance) {
  if (!is_voxel(tested.kind)) return true;
  const double t = tested.range / map.voxel_size;
  if (!(t >= limits.min_range - tolerance)) return false;
  const Eigen::Vector3d p = ray.origin + t * ray.direction;
  const Eigen::Vector3d relative = p - corner(tested.voxel, 0);
  const double outermost =
      std::max(-relative.minCoeff(), relative.maxCoeff() - 1.0);  // > 0: outside the voxel
  if (outermost > tolerance) return false;
  const bool starts_here = t <= std::max(limits.min_range, 0.0) + tolerance;
  return starts_here || outermost > -tolerance;
}

bool same_ending(const RayHit& a, const RayHit& b) {
  return a.kind == b.kind && (!is_voxel(a.kind) || a.voxel == b.voxel);
}

}  // namespace viewgain::oracle
