// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {

/// Buckets of points by the cube that a position [voxels] lies in. Cubes of one map do not share a
/// key.
template <typename Bucket>
class PointCells {
 public:
  /// Edge of a cube [voxels], at least kLeastEdge.
  explicit PointCells(double edge) : edge_(std::max(edge, kLeastEdge)) {}

  [[nodiscard]] Bucket& at(const Eigen::Vector3d& p) {
    const std::uint64_t number = key(cell(p.x()), cell(p.y()), cell(p.z()));
    std::size_t slot = slot_of(number);
    if (slots_[slot].bucket == kNone) {
      if (2 * (buckets_.size() + 1) > slots_.size()) {
        grow();
        slot = slot_of(number);
      }
      slots_[slot] = {number, buckets_.size()};
      buckets_.emplace_back();
    }
    return buckets_[slots_[slot].bucket];
  }

  [[nodiscard]] double edge() const { return edge_; }

  /// Whether f(bucket) is true for any cube within `radius` of p along each axis. Visits the cubes
  /// in a fixed order and stops at the first true.
  template <typename F>
  [[nodiscard]] bool any_near(const Eigen::Vector3d& p, double radius, F&& f) const {
    const double reach = 1.001 * radius;  // for any rounding of sums and quotients
    std::array<std::int64_t, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = cell(p[static_cast<Eigen::Index>(axis)] - reach);
      high[axis] = cell(p[static_cast<Eigen::Index>(axis)] + reach);
    }
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const std::size_t bucket = slots_[slot_of(key(i, j, k))].bucket;
          if (bucket != kNone && f(buckets_[bucket])) return true;
        }
      }
    }
    return false;
  }

  /// The bucket of each cube that has one.
  [[nodiscard]] std::vector<const Bucket*> buckets() const {
    std::vector<const Bucket*> result;
    result.reserve(buckets_.size());
    for (const Bucket& bucket : buckets_) result.push_back(&bucket);
    return result;
  }

 private:
  static constexpr double kLeastEdge = 0.1;  // smaller cubes save nothing

  [[nodiscard]] std::int64_t cell(double v) const {
    return static_cast<std::int64_t>(std::floor(v / edge_));
  }
  // A workspace has at most 2^16 voxels per axis, and cubes no edges below 0.1 voxels.
  [[nodiscard]] static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1FFFFFU; };
    return bits(x) << 42U | bits(y) << 21U | bits(z);
  }

  // Slot of the cube with this key, or a free slot for it.
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mix64(key) & mask;
    while (slots_[slot].bucket != kNone && slots_[slot].key != key) slot = (slot + 1) & mask;
    return slot;
  }
  void grow() {
    std::vector<Slot> before(2 * slots_.size());
    before.swap(slots_);
    for (const Slot& slot : before) {
      if (slot.bucket != kNone) slots_[slot_of(slot.key)] = slot;
    }
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Slot {
    std::uint64_t key = 0;
    std::size_t bucket = kNone;
  };

  double edge_;
  std::deque<Bucket> buckets_;
  // A hash table with open addressing, at most half full, because searches look up many cubes.
  std::vector<Slot> slots_ = std::vector<Slot>(1024);
};

}  // namespace viewgain::detail
