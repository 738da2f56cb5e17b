// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "viewgain/core/box.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// A half-line, with data for its intersections with boxes.
struct HalfLine {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< any length except zero
  Eigen::Vector3d inverse;    ///< 1 / direction; zero counts as a small positive number

  HalfLine(const Eigen::Vector3d& from, const Eigen::Vector3d& along)
      : origin(from), direction(along) {
    constexpr double kTiny = 1e-300;
    for (int k = 0; k < 3; ++k) inverse[k] = 1.0 / (std::abs(along[k]) < kTiny ? kTiny : along[k]);
  }

  /// Interval of its line inside a box, empty if the first value is not less than the second. In
  /// units of the direction.
  [[nodiscard]] std::array<double, 2> inside(const Box& box) const {
    std::array<double, 2> t{-1e300, 1e300};
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double a = (box.min[i] - origin[k]) * inverse[k];
      const double b = (box.max[i] - origin[k]) * inverse[k];
      t[0] = std::max(t[0], std::min(a, b));
      t[1] = std::min(t[1], std::max(a, b));
    }
    return t;
  }
};

/// Walks along a half-line from one cube of voxels to the next.
class VoxelWalk {
 public:
  VoxelWalk(const HalfLine& line, double from, const VoxelBox& box) : line_(line), from_(from) {
    const std::array<std::int32_t, 3> min{box.min.x, box.min.y, box.min.z};
    const std::array<std::int32_t, 3> max{box.max.x, box.max.y, box.max.z};
    for (std::size_t k = 0; k < 3; ++k) voxel_[k] = at(k, from, min[k], max[k] - 1);
  }

  [[nodiscard]] Index3 voxel() const { return {voxel_[0], voxel_[1], voxel_[2]}; }
  /// Entry point.
  [[nodiscard]] double from() const { return from_; }

  /// Leaves the current cube of this many voxels per edge; false if the length inside was zero.
  template <std::int32_t size>
  bool leave() {
    std::array<std::int32_t, 3> low{};
    std::array<double, 3> exit{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      low[k] = voxel_[k] & -size;
      exit[k] =
          ((is_rising(k) ? low[k] + size : low[k]) - line_.origin[axis]) * line_.inverse[axis];
    }
    const double out = std::min({exit[0], exit[1], exit[2]});
    for (std::size_t k = 0; k < 3; ++k) {
      if (exit[k] == out) {
        voxel_[k] = is_rising(k) ? low[k] + size : low[k] - 1;
      } else if constexpr (size > 1) {
        voxel_[k] = at(k, out, low[k], low[k] + size - 1);
      }
    }
    const bool has_length = out > from_;
    from_ = std::max(from_, out);
    return has_length;
  }

 private:
  [[nodiscard]] bool is_rising(std::size_t k) const {
    return line_.inverse[static_cast<Eigen::Index>(k)] > 0;
  }
  [[nodiscard]] std::int32_t at(std::size_t k, double t, std::int32_t low,
                                std::int32_t high) const {
    const auto axis = static_cast<Eigen::Index>(k);
    const double above = line_.origin[axis] + t * line_.direction[axis] - low;
    return low + static_cast<std::int32_t>(std::clamp(above, 0.0, static_cast<double>(high - low)));
  }

  const HalfLine& line_;
  double from_;
  std::array<std::int32_t, 3> voxel_{};
};

}  // namespace viewgain::detail
