// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "simulated_room.hpp"

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

}  // namespace

RayReturn SimulatedRoom::first_return(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) const {
  const SurfaceHit hit = object->intersect(origin, direction);
  RayReturn first{hit.range, std::abs(hit.normal.dot(direction))};
  if (surroundings) {
    const SurfaceHit other = surroundings->intersect(origin, direction);
    if (other.range < first.range) first = {other.range, std::abs(other.normal.dot(direction))};
  }
  if (background_radius > 0) {
    const double wall = sphere_exit(origin, direction, background_radius);
    if (wall < first.range) {
      first = {wall, std::abs((origin + wall * direction).dot(direction)) / background_radius};
    }
  }
  if (support_plane) {
    const double table = (*support_plane - origin.z()) / direction.z();  // NaN inside the plane
    if (table > 0 && table < first.range) first = {table, std::abs(direction.z())};
  }
  return first;
}

}  // namespace viewgain::detail
