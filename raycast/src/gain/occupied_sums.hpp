// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gain_kernels.hpp"
#include "viewgain/core/covariance.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// Σ T Λ_r of the occupied voxels in which a view's rays end, each at a *place*, in the order in
/// which they are first met. Serves view after view; allocates when a view meets more voxels than
/// any before.
class OccupiedSums {
 public:
  void begin() {
    count_ = 0;
    if (++generation_ == 0) {  // after 2^32 views old stamps would look new
      for (Slot& slot : slots_) slot.generation = 0;
      generation_ = 1;
    }
  }
  /// The voxel's place; of a new one, whose sum is not set yet, too.
  std::uint32_t place_of(Index3 voxel, bool& is_new) {
    if (2 * count_ >= slots_.size()) grow();
    Slot& slot = slot_of(voxel);
    is_new = slot.generation != generation_;
    if (is_new) {
      slot = {voxel, generation_, count_};
      voxels_[count_++] = voxel;
    }
    return slot.place;
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

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] Index3 voxel(std::uint32_t place) const { return voxels_[place]; }
  [[nodiscard]] SymmetricMatrix3 information(std::uint32_t place) const {
    return matrix_of(sums_[place]);
  }
  /// By place; the kernels add to them.
  [[nodiscard]] VoxelSum* sums() { return sums_.data(); }

 private:
  struct Slot {
    Index3 voxel;
    std::uint32_t generation = 0;  // void unless it is the view's
    std::uint32_t place = 0;
  };

  // Fibonacci hashing, linear probing; the table is at most half full.
  [[nodiscard]] Slot& slot_of(Index3 v) {
    const std::uint64_t key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(v.x)) << 42U) ^
                              (static_cast<std::uint64_t>(static_cast<std::uint32_t>(v.y)) << 21U) ^
                              static_cast<std::uint32_t>(v.z);
    std::size_t at = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> shift_);
    while (slots_[at].generation == generation_ && !(slots_[at].voxel == v)) {
      at = (at + 1) & (slots_.size() - 1);
    }
    return slots_[at];
  }
  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), Slot{});
    shift_ = 64U;
    for (std::size_t size = slots_.size(); size > 1; size /= 2) --shift_;
    for (std::uint32_t i = 0; i < count_; ++i) {
      slot_of(voxels_[i]) = {voxels_[i], generation_, i};
    }
    voxels_.resize(slots_.size());
    sums_.resize(slots_.size());
  }

  std::uint32_t count_ = 0;
  std::vector<Index3> voxels_;
  std::vector<VoxelSum> sums_;
  std::vector<Slot> slots_;
  unsigned shift_ = 64;
  std::uint32_t generation_ = 0;
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
