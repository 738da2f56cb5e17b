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

/// Counts the distinct voxels that the rays of a view pass: a bit a voxel, by nodes of 128³, which
/// are made when a ray first comes there and kept. Emptied in the time that marking took.
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
    table_ = &table;
  }

  void mark(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t word) {
    const std::size_t number = table_->node_index(x, y, z);
    std::unique_ptr<Node>& node = nodes_[number];
    if (!node) node = std::make_unique<Node>();
    const auto brick =
        static_cast<std::uint32_t>((x >> 3 & 15) << 8 | (y >> 3 & 15) << 4 | (z >> 3 & 15));
    if (node->is_touched[brick] == 0) {
      node->is_touched[brick] = 1;
      touched_.push_back({static_cast<std::uint32_t>(number), brick});
    }
    std::uint64_t& row = node->bits[brick * std::size_t{8} + static_cast<std::size_t>(x & 7)];
    const std::uint64_t bit = std::uint64_t{1} << ((y & 7) << 3 | (z & 7));
    if ((row & bit) != 0) return;
    row |= bit;
    ++count_;
    if (ClassicTable::is_frontier(word)) ++frontiers_;
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
  const ClassicTable* table_ = nullptr;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<Place> touched_;
  std::uint64_t count_ = 0, frontiers_ = 0;
};

}  // namespace viewgain::detail
