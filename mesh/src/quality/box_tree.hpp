// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"

namespace viewgain::detail {

/// A balanced tree of the bounding boxes of items, for nearest-item queries. Thread safety: const
/// members may run from many threads.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes);

  struct Nearest {
    std::uint32_t item = 0;
    double squared_distance = std::numeric_limits<double>::infinity();  ///< infinite: no items
  };

  /// The item with the least item_distance(item), the squared distance of p to it, which must not
  /// be under that to its box.
  template <typename ItemDistance>
  [[nodiscard]] Nearest nearest(const std::array<double, 3>& p,
                                const ItemDistance& item_distance) const {
    struct Pending {
      std::uint32_t node;
      double squared_distance;
    };
    std::array<Pending, 64> stack;  // the tree is balanced: its depth is under 32
    std::size_t size = 0;
    Nearest best;
    if (!nodes_.empty()) stack[size++] = {0, squared_distance(nodes_[0].box, p)};
    while (size > 0) {
      const Pending top = stack[--size];
      if (top.squared_distance >= best.squared_distance) continue;
      const Node& node = nodes_[top.node];
      if (node.right == 0) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
          const double d2 = item_distance(order_[i]);
          if (d2 < best.squared_distance) best = {order_[i], d2};
        }
        continue;
      }
      Pending near{top.node + 1, squared_distance(nodes_[top.node + 1].box, p)};
      Pending far{node.right, squared_distance(nodes_[node.right].box, p)};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
    }
    return best;
  }

 private:
  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0;  // items, into order_
    std::uint32_t right = 0;           // second child; the first follows the node; 0: a leaf
  };
  [[nodiscard]] static double squared_distance(const Box& box, const std::array<double, 3>& p) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double outside = std::max({box.min[k] - p[k], 0.0, p[k] - box.max[k]});
      sum += outside * outside;
    }
    return sum;
  }
  std::uint32_t build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end);

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace viewgain::detail
