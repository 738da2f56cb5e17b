// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "region_grower.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "surface/surface_access.hpp"

namespace viewgain::detail {

RegionGrower::RegionGrower(const SurfaceMesh& surface)
    : surface_(surface),
      first_(surface.vertices.size() + 1, 0),
      distance_(surface.vertices.size(), std::numeric_limits<double>::infinity()) {
  // Each corner of a face has two neighbours in it.
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) first_[v + 1] += 2;
  }
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  neighbors_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [a, b, c] : surface.triangles) {
    neighbors_[next[a]++] = b;
    neighbors_[next[a]++] = c;
    neighbors_[next[b]++] = c;
    neighbors_[next[b]++] = a;
    neighbors_[next[c]++] = a;
    neighbors_[next[c]++] = b;
  }
}

std::vector<std::uint32_t> RegionGrower::grow(std::span<const std::uint32_t> seeds, double depth,
                                              double max_turn) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : seeds) mean += normal(surface_, v);
  std::vector<std::uint32_t> region;
  if (mean.isZero(0)) return region;
  mean.normalize();
  const double min_cosine = std::cos(max_turn);

  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](std::uint32_t v, double distance) {
    if (!(distance <= depth) || distance >= distance_[v]) return;
    if (!(normal(surface_, v).dot(mean) > min_cosine)) return;
    if (std::isinf(distance_[v])) region.push_back(v);
    distance_[v] = distance;
    queue.emplace(distance, v);
  };
  for (const std::uint32_t v : seeds) offer(v, 0.0);
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > distance_[v]) continue;
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      const std::uint32_t n = neighbors_[i];
      offer(n, distance + (position(surface_, n) - position(surface_, v)).norm());
    }
  }
  for (const std::uint32_t v : region) distance_[v] = std::numeric_limits<double>::infinity();
  std::sort(region.begin(), region.end());
  return region;
}

}  // namespace viewgain::detail
