// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "box_hierarchy.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace viewgain::detail {
namespace {

constexpr std::uint32_t kItemsPerLeaf = 4;

Box nothing() {
  Box box;
  box.min.fill(std::numeric_limits<double>::infinity());
  box.max.fill(-std::numeric_limits<double>::infinity());
  return box;
}

void grow(Box& box, const std::array<double, 3>& low, const std::array<double, 3>& high) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], low[k]);
    box.max[k] = std::max(box.max[k], high[k]);
  }
}

}  // namespace

BoxHierarchy::BoxHierarchy(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  if (boxes_.empty()) return;
  order_.resize(boxes_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(boxes_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(boxes_.size()));
}

void BoxHierarchy::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  const auto begin = order_.begin() + first, end = begin + count;
  const auto twice_center = [this](std::uint32_t item, std::size_t axis) {
    return boxes_[item].min[axis] + boxes_[item].max[axis];
  };
  Box bounds = nothing(), centers = nothing();
  for (auto i = begin; i != end; ++i) {
    grow(bounds, boxes_[*i].min, boxes_[*i].max);
    const std::array<double, 3> center{twice_center(*i, 0), twice_center(*i, 1),
                                       twice_center(*i, 2)};
    grow(centers, center, center);
  }
  nodes_[node].box = bounds;
  if (count <= kItemsPerLeaf) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (centers.max[k] - centers.min[k] > centers.max[axis] - centers.min[axis]) axis = k;
  }
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, end, [&](std::uint32_t a, std::uint32_t b) {
    return twice_center(a, axis) < twice_center(b, axis);
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

}  // namespace viewgain::detail
