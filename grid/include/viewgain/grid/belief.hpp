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
/// What a voxel stores about the readings (measured depths) that ended in it. A leaf is a block of
/// 8³ voxels. The offset of a voxel in its leaf is x << 6 | y << 3 | z, with x, y and z in 0..7. A
/// leaf of scale s (0 to 3) is divided into cells of 2^s voxels per edge. All voxels of a cell
/// share one belief, which is stored at the cell's lowest voxel. Arguments are not checked.

namespace viewgain {

/// Sums over the readings that ended in a voxel or cell, in the grid frame. Single precision, as in
/// the map files.
struct VIEWGAIN_EXPORT Belief {
  std::array<float, 6> information{};  ///< Λ_v = Σ Λ_r: xx yy zz xy xz yz [m⁻²]
  /// η_v = Σ Λ_r (p_r - c) [m⁻¹], where p_r is a reading's point, Λ_r its information matrix and c
  /// the centre of the voxel or cell.
  std::array<float, 3> information_vector{};
  std::uint32_t hits = 0;  ///< number of readings

  /// Λ_v in double precision [m⁻²].
  [[nodiscard]] SymmetricMatrix3 information_matrix() const {
    return {information[0], information[1], information[2],
            information[3], information[4], information[5]};
  }
  bool operator==(const Belief&) const = default;
};

/// The voxel at an offset in a leaf. `origin` is the leaf's lowest voxel.
[[nodiscard]] inline Index3 offset_voxel(Index3 origin, unsigned offset) {
  return {origin.x + static_cast<std::int32_t>(offset >> 6U),
          origin.y + static_cast<std::int32_t>(offset >> 3U & 7U),
          origin.z + static_cast<std::int32_t>(offset & 7U)};
}

/// Offset of a voxel in its leaf.
[[nodiscard]] inline unsigned block_offset(Index3 voxel) {
  return static_cast<unsigned>((voxel.x & 7) << 6 | (voxel.y & 7) << 3 | (voxel.z & 7));
}

/// Offset of the lowest voxel of the cell that contains the voxel at `offset`, in a leaf of this
/// scale.
[[nodiscard]] inline unsigned cell_offset(unsigned offset, int scale) {
  const unsigned kept = 7U << static_cast<unsigned>(scale) & 7U;
  return offset & (kept << 6U | kept << 3U | kept);
}

/// Fraction of a cell's information that belongs to one of its voxels: 1 / 4^scale, because the
/// surface in a cell is assumed to pass through 4^scale voxels.
[[nodiscard]] inline double surface_share(int scale) { return 1.0 / (1 << 2 * scale); }

/// One bit per voxel of a leaf, in OpenVDB's order: word x, bit y << 3 | z.
using LeafMask = std::array<std::uint64_t, 8>;

/// Whether the voxel's bit is set.
[[nodiscard]] inline bool test_bit(const LeafMask& mask, unsigned offset) {
  return ((mask[offset >> 6U] >> (offset & 63U)) & 1U) != 0;
}

/// Sets the voxel's bit.
inline void set_bit(LeafMask& mask, unsigned offset) {
  mask[offset >> 6U] |= std::uint64_t{1} << (offset & 63U);
}

/// Calls f(offset) for every set bit, in order of increasing offset.
template <typename F>
void for_each_bit(const LeafMask& mask, F&& f) {
  for (unsigned w = 0; w < 8; ++w) {
    for (std::uint64_t word = mask[w]; word != 0; word &= word - 1) {
      f(w * 64U + static_cast<unsigned>(std::countr_zero(word)));
    }
  }
}

}  // namespace viewgain
