// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "exact_ray.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "classic_walk.hpp"

namespace viewgain::detail {
namespace {

// Along an axis that a ray does not move, planes are far away, or at 0 where it starts in one.
double inverse_of(double direction) { return direction == 0 ? 1e300 : 1 / direction; }

constexpr float kNever = 1e30F;  // as a reciprocal: planes are farther than any ray reaches
constexpr double kSteep = 1e3;   // reciprocals above are looked at more closely
constexpr double kClearOfPlane = 1e-3;
// The part of the origin that is rounded to single precision is below 1; with a margin.
constexpr double kOriginError = 1.5e-7;

}  // namespace

void ExactRays::begin(const ClassicView& view, const ClassicTile& tile, int lane0, int count) {
  view_ = &view;
  directions_[0] = tile.dx + lane0;
  directions_[1] = tile.dy + lane0;
  directions_[2] = tile.dz + lane0;
  const ClassicTable& table = view.table;
  for (int i = 0; i < count; ++i) {
    begin_at[i] = view.min_range;
    end_at[i] = tile.far[lane0 + i];
  }
  alignas(64) double inverses[3][kTileRays];
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = table.offset[a] - view.origin[a],
                 high = table.offset[a] + table.size[a] - view.origin[a];
    for (int i = 0; i < count; ++i) {
      const double inv = inverse_of(directions_[a][i]);
      inverses[a][i] = inv;
      begin_at[i] = std::max(begin_at[i], std::min(low * inv, high * inv));
      end_at[i] = std::min(end_at[i], std::max(low * inv, high * inv));
    }
  }
  active = 0;
  double steepest[kTileRays] = {};
  for (int i = 0; i < count; ++i) {
    const bool goes = (tile.valid >> (lane0 + i) & 1U) != 0 && begin_at[i] < end_at[i];
    active |= static_cast<unsigned>(goes) << static_cast<unsigned>(i);
    near[i] = goes ? static_cast<float>(begin_at[i]) : 0.0F;
    far[i] = goes ? static_cast<float>(end_at[i]) : 0.0F;
    steepest[i] = 1;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const double o = view.origin[a];
    const std::int32_t first = table.offset[a], last = first + table.size[a] - 1;
    for (int i = 0; i < count; ++i) {
      const bool goes = (active >> static_cast<unsigned>(i) & 1U) != 0;
      const double at = goes ? o + directions_[a][i] * begin_at[i] : first;
      voxel[a][i] = static_cast<std::int32_t>(
          std::clamp(std::floor(at), static_cast<double>(first), static_cast<double>(last)));
      const double inv = inverses[a][i], size = std::abs(inv);
      inverse[a][i] = static_cast<float>(std::clamp(inv, -1e30, 1e30));
      if (!goes || size <= kSteep) {
        steepest[i] = std::max(steepest[i], goes ? size : 1);
        continue;
      }
      const double to = o + directions_[a][i] * end_at[i];
      const double low = std::min(at, to) - kClearOfPlane, high = std::max(at, to) + kClearOfPlane;
      if (std::floor(low) == std::floor(high)) {
        inverse[a][i] = inv > 0 ? kNever : -kNever;
      } else {
        steepest[i] = std::max(steepest[i], size);
      }
    }
  }
  for (int i = 0; i < count; ++i)
    error[i] = static_cast<float>(kOriginError * std::min(steepest[i], 1e30));
}

double ExactRays::at_plane(int lane, std::size_t a, std::int32_t plane) const {
  return (static_cast<double>(plane) - view_->origin[a]) * inverse_of(directions_[a][lane]);
}

double ExactRays::enters(int lane, const std::array<std::int32_t, 3>& v) const {
  double t = begin_at[lane];
  for (std::size_t a = 0; a < 3; ++a) {
    const double d = directions_[a][lane];
    if (d != 0) t = std::max(t, at_plane(lane, a, d > 0 ? v[a] : v[a] + 1));
  }
  return t;
}

ExactStep ExactRays::step(int lane, const std::array<std::int32_t, 3>& v, std::int32_t edge) const {
  std::array<double, 3> leaves;
  std::array<std::int32_t, 3> low;
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = v[a] & -edge;
    leaves[a] = at_plane(lane, a, directions_[a][lane] < 0 ? low[a] : low[a] + edge);
  }
  const double exit = std::min({leaves[0], leaves[1], leaves[2]}), end = end_at[lane],
               t = enters(lane, v), next = std::max(t, std::min(exit, end));
  ExactStep step;
  step.has_length = t < next;
  step.goes_on = exit < end;
  for (std::size_t a = 0; a < 3; ++a) {
    const bool is_forward = !(directions_[a][lane] < 0), crosses = leaves[a] <= exit && exit <= end;
    const auto inside = static_cast<std::int32_t>(
        std::clamp(std::floor(view_->origin[a] + directions_[a][lane] * next),
                   static_cast<double>(low[a]), static_cast<double>(low[a] + edge - 1)));
    const std::int32_t last = !crosses ? inside : is_forward ? low[a] + edge - 1 : low[a];
    step.voxels += std::abs(last - v[a]);
    step.beyond[a] = !crosses ? last : is_forward ? last + 1 : last - 1;
  }
  return step;
}

}  // namespace viewgain::detail
