// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// Numbers the voxels that a view meets, in the order in which it first meets them. Serves view
/// after view; allocates when a view meets more voxels than any before.
class VoxelPlaces {
 public:
  void begin() {
    count_ = 0;
    if (++generation_ == 0) {  // after 2^32 views old stamps would look new
      for (Slot& slot : slots_) slot.generation = 0;
      generation_ = 1;
    }
  }
  /// The voxel's place, and whether it is met for the first time.
  std::uint32_t of(Index3 voxel, bool& is_new) {
    if (2 * count_ >= slots_.size()) grow();
    Slot& slot = slot_of(voxel);
    is_new = slot.generation != generation_;
    if (is_new) {
      slot = {voxel, generation_, count_};
      voxels_[count_++] = voxel;
    }
    return slot.place;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// How many places there are before it allocates again.
  [[nodiscard]] std::size_t capacity() const { return voxels_.size(); }
  [[nodiscard]] Index3 voxel(std::uint32_t place) const { return voxels_[place]; }

 private:
  struct Slot {
    Index3 voxel;
    std::uint32_t generation = 0;  // void unless it is the view's
    std::uint32_t place = 0;
  };

  // Fibonacci hashing of cubes of 2³ voxels, whose slots are neighbours as a ray's voxels are;
  // linear probing; the table is at most half full.
  [[nodiscard]] Slot& slot_of(Index3 v) {
    const auto bits = [](std::int32_t i) { return static_cast<std::uint32_t>(i); };
    const std::uint64_t cube = (static_cast<std::uint64_t>(bits(v.x >> 1)) << 42U) ^
                               (static_cast<std::uint64_t>(bits(v.y >> 1)) << 21U) ^ bits(v.z >> 1);
    const auto in_cube = static_cast<std::size_t>((v.x & 1) << 2 | (v.y & 1) << 1 | (v.z & 1));
    std::size_t at =
        static_cast<std::size_t>((cube * 0x9E3779B97F4A7C15ULL) >> (shift_ + 3)) << 3U | in_cube;
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
  }

  std::uint32_t count_ = 0;
  std::vector<Index3> voxels_;
  std::vector<Slot> slots_;
  unsigned shift_ = 64;
  std::uint32_t generation_ = 0;
};

}  // namespace viewgain::detail
