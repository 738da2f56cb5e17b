// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "viewgain/core/covariance.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/voxel.hpp"

/// @file
/// What a voxel stores about its readings, the measured depths that ended in it. Functions and
/// members check nothing: an offset must be below 512.

namespace viewgain {

/// Sums over the readings of a voxel, or of a cell of voxels, in single precision as in the map
/// files; grid frame.
struct VIEWGAIN_EXPORT Belief {
  std::array<float, 6> information{};  ///< Λ_v: xx yy zz xy xz yz [m⁻²]
  /// η_v = Σ Λ_r (p_r - centre of the voxel, or of its cell) [m⁻¹]
  std::array<float, 3> information_vector{};
  std::uint32_t hits = 0;  ///< number of readings that ended here

  /// Λ_v in double precision [m⁻²].
  [[nodiscard]] SymmetricMatrix3 information_matrix() const {
    return {information[0], information[1], information[2],
            information[3], information[4], information[5]};
  }
  bool operator==(const Belief&) const = default;
};

/// The voxel at an offset (x << 6 | y << 3 | z) in a leaf. `origin` is the leaf's lowest voxel.
[[nodiscard]] inline Index3 offset_voxel(Index3 origin, unsigned offset) {
  return {origin.x + static_cast<std::int32_t>(offset >> 6U),
          origin.y + static_cast<std::int32_t>(offset >> 3U & 7U),
          origin.z + static_cast<std::int32_t>(offset & 7U)};
}

/// Offset (x << 6 | y << 3 | z) of a grid voxel in its 8³ leaf.
[[nodiscard]] inline unsigned block_offset(Index3 voxel) {
  return static_cast<unsigned>((voxel.x & 7) << 6 | (voxel.y & 7) << 3 | (voxel.z & 7));
}

/// Offset of the lowest voxel of the cell that contains the voxel at `offset`. A leaf of scale s, 0
/// to 3, has one belief per cell of 2^s voxels per edge, stored at the cell's lowest voxel.
[[nodiscard]] inline unsigned cell_offset(unsigned offset, int scale) {
  const unsigned kept = 7U << static_cast<unsigned>(scale) & 7U;
  return offset & (kept << 6U | kept << 3U | kept);
}

/// Fraction of a cell's information that belongs to one voxel, 1 / 4^scale. The surface in a cell
/// is assumed to pass through 4^scale voxels.
[[nodiscard]] inline double surface_share(int scale) { return 1.0 / (1 << 2 * scale); }

/// One bit per voxel of an 8³ leaf: word x, bit y << 3 | z (OpenVDB's order).
using LeafMask = std::array<std::uint64_t, 8>;

/// Whether the voxel's bit is set.
[[nodiscard]] inline bool test_bit(const LeafMask& mask, unsigned offset) {
  return ((mask[offset >> 6U] >> (offset & 63U)) & 1U) != 0;
}

/// Sets the voxel's bit.
inline void set_bit(LeafMask& mask, unsigned offset) {
  mask[offset >> 6U] |= std::uint64_t{1} << (offset & 63U);
}

/// Calls f(offset) for every set bit, in increasing order.
template <typename F>
void for_each_bit(const LeafMask& mask, F&& f) {
  for (unsigned w = 0; w < 8; ++w) {
    for (std::uint64_t word = mask[w]; word != 0; word &= word - 1) {
      f(w * 64U + static_cast<unsigned>(std::countr_zero(word)));
    }
  }
}

}  // namespace viewgain
