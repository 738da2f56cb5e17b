// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "simulated_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace viewgain::detail {
namespace {

// Where a ray from inside the sphere of radius r round the origin leaves it; outside: infinity,
// then the room is not there.
double sphere_exit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double r) {
  const double b = origin.dot(direction);
  const double c = origin.squaredNorm() - r * r;
  if (c > 0) return std::numeric_limits<double>::infinity();
  return -b + std::sqrt(b * b - c);
}

// The sphere and the table, where they are nearer.
void meet_walls(const SimulatedRoom& room, const SurfaceRay& ray, RayReturn& first) {
  const Eigen::Vector3d &origin = ray.origin, &direction = ray.direction;
  if (room.background_radius > 0) {
    const double wall = sphere_exit(origin, direction, room.background_radius);
    if (wall < first.range) {
      first = {wall, std::abs((origin + wall * direction).dot(direction)) / room.background_radius};
    }
  }
  if (room.support_plane) {
    const double table =
        (*room.support_plane - origin.z()) / direction.z();  // NaN inside the plane
    if (table > 0 && table < first.range) first = {table, std::abs(direction.z())};
  }
}

}  // namespace

void SimulatedRoom::first_returns(std::span<const SurfaceRay> rays,
                                  std::span<RayReturn> returns) const {
  constexpr std::size_t kAtOnce = 64;
  std::array<SurfaceHit, kAtOnce> hits;
  for (std::size_t first = 0; first < rays.size(); first += kAtOnce) {
    const auto some = rays.subspan(first, std::min(kAtOnce, rays.size() - first));
    const auto found = returns.subspan(first, some.size());
    std::fill(found.begin(), found.end(), RayReturn{});
    for (const SurfaceScene* scene : {object.get(), surroundings.get()}) {
      if (scene == nullptr) continue;
      scene->intersect(some, hits);
      for (std::size_t i = 0; i < some.size(); ++i) {
        if (!(hits[i].range < found[i].range)) continue;
        found[i] = {hits[i].range, std::abs(hits[i].normal.dot(some[i].direction))};
      }
    }
    for (std::size_t i = 0; i < some.size(); ++i) meet_walls(*this, some[i], found[i]);
  }
}

}  // namespace viewgain::detail
