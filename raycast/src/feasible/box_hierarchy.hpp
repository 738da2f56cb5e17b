// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/core/box.hpp"

namespace viewgain::detail {

/// A binary tree over axis-aligned boxes, to find those near a place. Items are numbered as the
/// boxes were.
class BoxHierarchy {
 public:
  /// n log n for n boxes.
  explicit BoxHierarchy(std::vector<Box> boxes);

  /// Whether visit(item) is true for one of the boxes that meet `range`, limits included. Stops at
  /// the first.
  template <typename Visit>
  [[nodiscard]] bool any(const Box& range, const Visit& visit) const {
    if (nodes_.empty()) return false;
    std::array<std::uint32_t, kMaxDepth> stack{};
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!meet(node.box, range)) continue;
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = node.first + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (meet(boxes_[order_[i]], range) && visit(order_[i])) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::size_t kMaxDepth = 64;  ///< halves of 2^32 items, one waiting a level

  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< the first of two children, or of `count` places in order_
    std::uint32_t count = 0;  ///< 0: an inner node
  };

  [[nodiscard]] static bool meet(const Box& a, const Box& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
    }
    return true;
  }
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace viewgain::detail
