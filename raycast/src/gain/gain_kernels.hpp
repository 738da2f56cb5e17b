// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "frontal_sigmas.hpp"
#include "trace/ray_tile.hpp"
#include "viewgain/core/covariance.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

inline constexpr std::size_t kBatchSize = 256;

/// Hits on their way from the tracer to the voxels, in the order of tiles and lanes. The arrays
/// have room for one more tile's vectors beyond kBatchSize.
struct alignas(64) HitList {
  static constexpr std::size_t kCapacity = kBatchSize + 2 * kTileRays;
  float dx[kCapacity] = {}, dy[kCapacity] = {}, dz[kCapacity] = {};
  float range[kCapacity] = {};  ///< [voxels]
  std::uint32_t primitive[kCapacity], offset[kCapacity];
  std::size_t count = 0;
};

struct HitBatch : HitList {
  float expected[kCapacity];  ///< of a sample's hits, see VoxelSums::add()
  /// Λ_r [m⁻²], filled by expand(): xx yy zz xy and xz yz 0 0.
  alignas(64) double information_a[kCapacity][4], information_b[kCapacity][4];
};

/// What one view would add to one voxel: Σ Λ_r [m⁻²]; one cache line.
struct alignas(64) VoxelSum {
  double a[4];  ///< xx yy zz xy
  double b[4];  ///< xz yz 0 0
};

[[nodiscard]] inline SymmetricMatrix3 matrix_of(const VoxelSum& m) {
  return {m.a[0], m.a[1], m.a[2], m.a[3], m.b[0], m.b[1]};
}

/// Half of a symmetric matrix as in VoxelSum.
struct alignas(32) MatrixHalf {
  double value[4];
};

/// ln of a long product of positive numbers in eight strands, one logarithm for all of it: factor i
/// goes to strand i mod 8, whatever the vector width, and mantissas hand their exponents over as
/// they grow.
struct alignas(64) LogProduct {
  double mantissa[8] = {1, 1, 1, 1, 1, 1, 1, 1};
  std::int64_t exponent[8] = {};

  [[nodiscard]] double log() const;
};

/// The voxels of one class (unknown or occupied) that a view touches.
struct VoxelClass {
  const VoxelSum* sums;  ///< of all voxels
  const std::uint32_t*
      members;                ///< which of them belong to the class; readable up to 8 beyond count
  const MatrixHalf* known_a;  ///< Λ_v of the members: xx yy zz xy; null: unknown, none
  const MatrixHalf* known_b;  ///< xz yz, and two numbers that are not looked at
  std::size_t count;
};

/// The arithmetic of the gain for one instruction set.
struct GainKernels {
  /// Appends the hits of a tile.
  void (*append)(const RayTile& tile, HitList& hits);
  /// Λ_r = a I + (b - a) d dᵀ of every hit, d normalised in double.
  void (*expand)(const FrontalSigmas& sigmas, double voxel_size, HitBatch& batch);
  /// Adds the batch's Λ_r to the sums at `places`, in order. Where keep[i] is 0 hit i is the first
  /// of its voxel, and what stood there is forgotten; else it is all ones.
  void (*accumulate)(const HitBatch& batch, const std::uint32_t* places, const std::uint64_t* keep,
                     VoxelSum* sums);
  /// Λ_v of occupied voxels, xx yy zz xy and xz yz hits 0: voxel i is the one at offsets[i] of
  /// blocks[i], which may be null; its share of its cell's (surface_share()); zero without a
  /// belief.
  void (*look_up)(const BeliefBlock* const* blocks, const std::uint32_t* offsets, std::size_t count,
                  MatrixHalf* known_a, MatrixHalf* known_b);
  /// What the members gain and what stays. Multiplies the ratios whose logarithms, halved, are
  /// H(before) - H(after) into `ratios`, or, if `each` is not null (room for 8 beyond count),
  /// writes each ratio there, for the trace each difference. Multiplies Π_k [(Λ_v + ΣΛ_r)⁻¹]_kk
  /// into `posterior` unless that is null.
  void (*finish)(Criterion criterion, double prior_information, const VoxelClass& voxels,
                 LogProduct& ratios, LogProduct* posterior, double* each);
  /// The ratios by log_diagonal with a floor, H_F(Λ) = ½ Σ_k ln [Λ⁻¹ + F]_kk, F = `floor` I [m²],
  /// into `each` (room for 8 beyond count).
  void (*finish_with_floor)(double prior_information, double floor, const VoxelClass& voxels,
                            double* each);
};

[[nodiscard]] const GainKernels& gain_kernels(Isa isa);

}  // namespace viewgain::detail
