// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "ray_lattices.hpp"

#include <algorithm>
#include <cmath>

#include "viewgain/support/mix64.hpp"

namespace viewgain::detail {
namespace {

// Fewer rays of a view say nothing.
constexpr double kLeastRays = 100;

// Pixels of an image with rays, along one edge, beyond those between a lattice's first and last.
int beyond(int rays, int step) { return (rays - 1) % step; }

}  // namespace

int step_for_rays(const EvaluatorCore& core, double rays) {
  return std::max(1, static_cast<int>(std::lround(std::sqrt(core.ray_count / rays))));
}

int step_for_share(const EvaluatorCore& core, double share) {
  const int wanted = static_cast<int>(std::ceil(std::sqrt(1 / share) * (1 - 1e-12)));
  const int most = static_cast<int>(std::sqrt(core.ray_count / kLeastRays));
  return std::max(1, std::min(wanted, most));
}

RayLattice centred_lattice(const EvaluatorCore& core, int step) {
  const TileTable& table = core.rays->table;
  return {step, beyond(table.columns, step) / 2, beyond(table.rows, step) / 2};
}

RayLattice random_lattice(const EvaluatorCore& core, int step, std::uint64_t seed) {
  const TileTable& table = core.rays->table;
  const auto below = [&](int rays, std::uint64_t number) {
    const int count = std::min(step, rays);
    return std::min(static_cast<int>(unit_number(mix64(mix64(seed) + number)) * count), count - 1);
  };
  return {step, below(table.columns, 0), below(table.rows, 1)};
}

}  // namespace viewgain::detail
