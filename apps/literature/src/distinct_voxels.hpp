// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "classic_table.hpp"

namespace viewgain::detail {

/// Counts the distinct unknown voxels that the rays of a view pass: a bit a voxel, by nodes of
/// 128³, which are made when a ray first comes there and kept. Emptied in the time that marking
/// took.
class DistinctVoxels {
 public:
  /// For another view, of a table of any size.
  void begin(const ClassicTable& table) {
    for (const Place& place : touched_) {
      Node& node = *nodes_[place.node];
      std::fill_n(node.bits.begin() + place.brick * std::size_t{8}, 8, 0);
      node.is_touched[place.brick] = 0;
    }
    touched_.clear();
    count_ = frontiers_ = 0;
    if (nodes_.size() < table.node_entries.size()) nodes_.resize(table.node_entries.size());
  }

  /// `place` is the number of a voxel's brick in its node, times 512, plus any number of the voxel
  /// in its brick.
  void mark(std::uint32_t number, std::uint32_t place, std::uint32_t word) {
    std::unique_ptr<Node>& node = nodes_[number];
    if (!node) node = std::make_unique<Node>();
    const std::uint32_t brick = place >> 9U;
    if (node->is_touched[brick] == 0) {
      touched_.push_back({number, brick});  // first: where it throws, nothing is marked for ever
      node->is_touched[brick] = 1;
    }
    std::uint64_t& bits = node->bits[place >> 6U];
    // No branch: whether another ray was here before cannot be foretold.
    const std::uint64_t is_new = ~bits >> (place & 63U) & 1U;
    bits |= is_new << (place & 63U);
    count_ += is_new;
    frontiers_ += is_new & word;
    static_assert(ClassicTable::kFrontier == 1);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t frontiers() const { return frontiers_; }

 private:
  struct Node {
    std::array<std::uint64_t, std::size_t{4096} * 8> bits{};
    std::array<std::uint8_t, 4096> is_touched{};
  };
  struct Place {
    std::uint32_t node, brick;
  };
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<Place> touched_;
  std::uint64_t count_ = 0, frontiers_ = 0;
};

}  // namespace viewgain::detail
