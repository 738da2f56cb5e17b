// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "viewgain/core/covariance.hpp"
#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

/// Σ T Λ_r of the occupied voxels in which a view's rays end, in the order in which they are first
/// met. Serves view after view; allocates when a view meets more voxels than any before.
class OccupiedSums {
 public:
  struct Entry {
    Index3 voxel;
    SymmetricMatrix3 information;  ///< [m⁻²]
  };

  void begin() {
    entries_.clear();
    if (++generation_ == 0) {  // after 2^32 views old stamps would look new
      for (Slot& slot : slots_) slot.generation = 0;
      generation_ = 1;
    }
  }
  /// Returns the voxel's entry.
  std::size_t add(Index3 voxel, const SymmetricMatrix3& information) {
    if (2 * entries_.size() >= slots_.size()) grow();
    Slot& slot = slot_of(voxel);
    if (slot.generation != generation_) {
      slot = {generation_, static_cast<std::uint32_t>(entries_.size())};
      entries_.push_back({voxel, information});
    } else {
      entries_[slot.entry].information += information;
    }
    return slot.entry;
  }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

 private:
  struct Slot {
    std::uint32_t generation = 0;  // void unless it is the view's
    std::uint32_t entry = 0;
  };

  // Fibonacci hashing, linear probing; the table is at most half full.
  [[nodiscard]] Slot& slot_of(Index3 v) {
    const std::uint64_t key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(v.x)) << 42U) ^
                              (static_cast<std::uint64_t>(static_cast<std::uint32_t>(v.y)) << 21U) ^
                              static_cast<std::uint32_t>(v.z);
    std::size_t place = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> shift_);
    while (slots_[place].generation == generation_ && !(entries_[slots_[place].entry].voxel == v)) {
      place = (place + 1) & (slots_.size() - 1);
    }
    return slots_[place];
  }
  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), Slot{});
    shift_ = 64U;
    for (std::size_t size = slots_.size(); size > 1; size /= 2) --shift_;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      slot_of(entries_[i].voxel) = {generation_, static_cast<std::uint32_t>(i)};
    }
  }

  std::vector<Entry> entries_;
  std::vector<Slot> slots_;
  unsigned shift_ = 64;
  std::uint32_t generation_ = 0;
};

}  // namespace viewgain::detail
