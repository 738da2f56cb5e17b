// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// State of a voxel, a cube of the map. In all languages, arrays of states contain these numbers.
enum class VoxelState : std::uint8_t { unknown = 0, free = 1, occupied = 2 };

/// Index of a voxel on the lattice of a grid. Voxel (0, 0, 0) has its lowest corner at the origin
/// of the grid frame.
struct VIEWGAIN_EXPORT Index3 {
  std::int32_t x = 0, y = 0, z = 0;  ///< the voxel covers [x, x+1) × [y, y+1) × [z, z+1), in voxels
  bool operator==(const Index3&) const = default;
};

/// The voxel that contains the point `p`, which is in the grid frame and in units of voxels. The
/// absolute values of its coordinates must be below 2^31.
[[nodiscard]] inline Index3 voxel_of(const Eigen::Vector3d& p) {
  const auto rounded_down = [](double value) {  // faster than std::floor
    const auto towards_zero = static_cast<std::int32_t>(value);
    return towards_zero - (value < towards_zero ? 1 : 0);
  };
  return {rounded_down(p.x()), rounded_down(p.y()), rounded_down(p.z())};
}

/// A box of voxels. It contains `min` but not `max`, and is empty if a side is not positive.
/// Members accept any voxel and never throw.
struct VIEWGAIN_EXPORT VoxelBox {
  Index3 min;  ///< lowest voxel
  Index3 max;  ///< one past the highest voxel, on each axis

  /// The box with lowest voxel `min` and `dims` voxels along x, y and z.
  [[nodiscard]] static VoxelBox from_dims(Index3 min, Index3 dims) {
    return {min, {min.x + dims.x, min.y + dims.y, min.z + dims.z}};
  }

  /// Whether the box contains the voxel.
  [[nodiscard]] bool contains(Index3 v) const {
    return v.x >= min.x && v.x < max.x && v.y >= min.y && v.y < max.y && v.z >= min.z &&
           v.z < max.z;
  }
  /// The voxel of the box that contains the point `p`, which is in the grid frame and in units of
  /// voxels. Empty if the point lies outside the box or is not finite.
  [[nodiscard]] std::optional<Index3> voxel_at(const Eigen::Vector3d& p) const {
    if (!(p.x() >= min.x && p.x() < max.x && p.y() >= min.y && p.y() < max.y && p.z() >= min.z &&
          p.z() < max.z)) {
      return std::nullopt;
    }
    return voxel_of(p);
  }

  /// Number of voxels; 0 if the box is empty.
  [[nodiscard]] std::uint64_t volume() const {
    const auto side = [](std::int32_t from, std::int32_t to) {
      return to > from ? static_cast<std::uint64_t>(std::int64_t{to} - from) : 0U;
    };
    return side(min.x, max.x) * side(min.y, max.y) * side(min.z, max.z);
  }
  /// The intersection of both boxes.
  [[nodiscard]] VoxelBox intersection(const VoxelBox& other) const {
    return {
        {std::max(min.x, other.min.x), std::max(min.y, other.min.y), std::max(min.z, other.min.z)},
        {std::min(max.x, other.max.x), std::min(max.y, other.max.y), std::min(max.z, other.max.z)}};
  }
  bool operator==(const VoxelBox&) const = default;
};

/// Centre, in the grid frame [m], of the cell of 2^scale voxels per edge whose lowest voxel is
/// `voxel`. With scale 0 it is the centre of the voxel. voxel_size [m] is the edge of a voxel.
/// Arguments are not checked.
[[nodiscard]] inline Eigen::Vector3d voxel_center(Index3 voxel, double voxel_size, int scale = 0) {
  return (Eigen::Vector3d(voxel.x, voxel.y, voxel.z).array() + 0.5 * (1 << scale)) * voxel_size;
}

}  // namespace viewgain
