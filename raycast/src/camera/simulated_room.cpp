// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "simulated_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace viewgain::detail {
namespace {

// The sphere and the table, where they are nearer.
void meet_walls(const SimulatedRoom& room, const SurfaceScene::Ray& ray, RayReturn& first) {
  const Eigen::Vector3d &origin = ray.origin, &direction = ray.direction;
  if (const double r = room.background_radius; r > 0) {
    const double b = origin.dot(direction), c = origin.squaredNorm() - r * r;
    // From outside of the sphere it is not there; what is met inside is nearer than its wall.
    if (c <= 0 && !(first.range * (first.range + 2 * b) + c < 0)) {
      const double wall = -b + std::sqrt(b * b - c);
      if (wall < first.range)
        first = {wall, std::abs((origin + wall * direction).dot(direction)) / r};
    }
  }
  if (room.support_plane) {
    const double table =
        (*room.support_plane - origin.z()) / direction.z();  // NaN inside the plane
    if (table > 0 && table < first.range) first = {table, std::abs(direction.z())};
  }
}

}  // namespace

void SimulatedRoom::first_returns(std::span<const SurfaceScene::Ray> rays,
                                  std::span<RayReturn> returns) const {
  constexpr std::size_t kAtOnce = 64;
  std::array<SurfaceScene::Hit, kAtOnce> hits;
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
