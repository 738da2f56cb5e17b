// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "classic_table.hpp"

namespace viewgain::detail {

/// What a ray has of a cube whose voxels are the same.
struct CubeVisit {
  std::uint32_t word = 0;               ///< as ClassicTable's
  std::array<std::int32_t, 3> voxel{};  ///< the first, table coordinates
  std::uint32_t voxels = 0;             ///< how many
  double begin = 0, end = 0;            ///< along the ray [voxels]
};

/// Takes a ray through the table in double precision, cube by cube.
/// Plane distances are (plane - origin) / direction each time, never added up.
class OrderedRay {
 public:
  /// The part of the ray within the workspace and [near, far]. Lengths in voxels, table
  /// coordinates; the direction has unit length.
  OrderedRay(const ClassicTable& table, const std::array<double, 3>& origin,
             const std::array<double, 3>& direction, double near, double far)
      : table_(table), origin_(origin), direction_(direction), t_(near), end_(far) {
    for (std::size_t a = 0; a < 3; ++a) {
      // Along an axis that it does not move, planes are far away, or at 0 where it starts in one.
      inverse_[a] = direction_[a] == 0 ? 1e300 : 1 / direction_[a];
      const double low = at_plane(a, table_.offset[a]),
                   high = at_plane(a, table_.offset[a] + table_.size[a]);
      t_ = std::max(t_, std::min(low, high));
      end_ = std::min(end_, std::max(low, high));
    }
    if (!(t_ < end_)) return;
    for (std::size_t a = 0; a < 3; ++a) {
      voxel_[a] = voxel_at(a, t_, table_.offset[a], table_.offset[a] + table_.size[a] - 1);
    }
  }

  [[nodiscard]] bool goes_on() const { return t_ < end_; }

  /// The next cube, or voxel where `is_split(word)`; of zero length where the ray only touches it.
  template <typename IsSplit>
  CubeVisit next(IsSplit&& is_split) {
    CubeVisit visit;
    const std::uint32_t word = table_.word(voxel_[0], voxel_[1], voxel_[2]);
    const std::int32_t edge = is_split(word) ? 1 : ClassicTable::edge(word);
    std::array<double, 3> leaves;
    std::array<std::int32_t, 3> low;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = voxel_[a] & -edge;
      leaves[a] = at_plane(a, inverse_[a] > 0 ? low[a] + edge : low[a]);
    }
    const double exit = std::min({leaves[0], leaves[1], leaves[2]});
    const double next = std::max(t_, std::min(exit, end_));
    visit = {word, voxel_, 1, t_, next};
    for (std::size_t a = 0; a < 3; ++a) {
      const bool is_forward = inverse_[a] > 0;
      const bool crosses = leaves[a] <= exit && exit <= end_;
      const std::int32_t last = crosses      ? (is_forward ? low[a] + edge - 1 : low[a])
                                : is_forward ? voxel_at(a, next, voxel_[a], low[a] + edge - 1)
                                             : voxel_at(a, next, low[a], voxel_[a]);
      visit.voxels += static_cast<std::uint32_t>(std::abs(last - voxel_[a]));
      voxel_[a] = crosses ? last + (is_forward ? 1 : -1) : last;
    }
    t_ = exit < end_ ? next : end_;
    return visit;
  }

 private:
  [[nodiscard]] double at_plane(std::size_t a, std::int32_t plane) const {
    return (static_cast<double>(plane) - origin_[a]) * inverse_[a];
  }
  [[nodiscard]] std::int32_t voxel_at(std::size_t a, double t, std::int32_t low,
                                      std::int32_t high) const {
    return std::clamp(static_cast<std::int32_t>(std::floor(origin_[a] + direction_[a] * t)), low,
                      high);
  }

  const ClassicTable& table_;
  std::array<double, 3> origin_, direction_, inverse_{};
  double t_, end_;
  std::array<std::int32_t, 3> voxel_{};
};

}  // namespace viewgain::detail
