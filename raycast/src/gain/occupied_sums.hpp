// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gain_kernels.hpp"
#include "viewgain/core/covariance.hpp"
#include "viewgain/grid/voxel.hpp"
#include "voxel_places.hpp"

namespace viewgain::detail {

/// Σ T Λ_r of the occupied voxels in which a view's rays end, each at a *place*.
class OccupiedSums {
 public:
  void begin() { places_.begin(); }
  /// The voxel's place; of a new one, whose sum is not set yet, too.
  std::uint32_t place_of(Index3 voxel, bool& is_new) {
    const std::uint32_t place = places_.of(voxel, is_new);
    if (sums_.size() < places_.capacity()) sums_.resize(places_.capacity());
    return place;
  }
  /// Adds to the voxel's sum; returns its place.
  std::uint32_t add(Index3 voxel, const SymmetricMatrix3& m) {
    bool is_new = false;
    const std::uint32_t place = place_of(voxel, is_new);
    VoxelSum& sum = sums_[place];
    const SymmetricMatrix3 whole = is_new ? m : matrix_of(sum) + m;
    sum = {{whole.xx, whole.yy, whole.zz, whole.xy}, {whole.xz, whole.yz, 0, 0}};
    return place;
  }

  [[nodiscard]] std::uint32_t count() const { return places_.count(); }
  [[nodiscard]] Index3 voxel(std::uint32_t place) const { return places_.voxel(place); }
  [[nodiscard]] SymmetricMatrix3 information(std::uint32_t place) const {
    return matrix_of(sums_[place]);
  }
  /// By place; the kernels add to them.
  [[nodiscard]] VoxelSum* sums() { return sums_.data(); }

 private:
  VoxelPlaces places_;
  std::vector<VoxelSum> sums_;
};

/// Rays that end in occupied voxels, on their way into the sums.
struct RefiningHits {
  HitBatch batch;
  float passed[HitList::kCapacity];  ///< T of each
  std::uint32_t places[HitList::kCapacity];
  std::uint64_t keep[HitList::kCapacity];  ///< as GainKernels::accumulate() has it
  // What the gain is made of, by place.
  std::vector<const GridSnapshot::Leaf*> leaves;
  std::vector<std::uint32_t> offsets, members;
  std::vector<MatrixHalf> known_a, known_b;
  std::vector<double> each;
};

}  // namespace viewgain::detail
