// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace viewgain::detail {
namespace {

constexpr std::uint32_t kLeafSize = 4;

Box grown(const Box& a, const Box& b) {
  Box result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.min[k] = std::min(a.min[k], b.min[k]);
    result.max[k] = std::max(a.max[k], b.max[k]);
  }
  return result;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes.empty()) build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

std::uint32_t BoxTree::build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end) {
  Box box = boxes[order_[begin]];
  for (std::uint32_t i = begin + 1; i < end; ++i) box = grown(box, boxes[order_[i]]);
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= kLeafSize) return index;

  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (box.max[k] - box.min[k] > box.max[axis] - box.min[axis]) axis = k;
  }
  const auto key = [&](std::uint32_t item) {
    return std::pair(boxes[item].min[axis] + boxes[item].max[axis], item);
  };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  build(boxes, begin, middle);
  const std::uint32_t right = build(boxes, middle, end);
  nodes_[index].right = right;
  return index;
}

}  // namespace viewgain::detail
