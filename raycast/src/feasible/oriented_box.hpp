// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/support/voxel_walk.hpp"

namespace viewgain::detail {

/// A box with any orientation against axis-aligned boxes and triangles, by separating axes: exact
/// but for rounding. Overlaps of less than `touch` along an axis count as touching, not as
/// overlapping. All lengths in one unit, whatever it is.
class OrientedBox {
 public:
  /// Columns of R: the box's axes, orthonormal; `half`: half its size along them.
  OrientedBox(const Eigen::Vector3d& center, const Eigen::Matrix3d& R, const Eigen::Vector3d& half,
              double touch);

  /// The axis-aligned box round it.
  [[nodiscard]] Box bounds() const;

  /// Distances between centres from which on a box of this half size is separated, one an axis. For
  /// testing many boxes of one size.
  using Limits = std::array<double, 15>;
  [[nodiscard]] Limits limits(const Eigen::Vector3d& half_other) const;

  /// Against an axis-aligned box of the size that the limits are for.
  [[nodiscard]] bool overlaps(const Eigen::Vector3d& center_other, const Limits& limits) const {
    const Eigen::Vector3d offset = center_other - center_;
    for (std::size_t i = 0; i < axis_count_; ++i) {
      if (std::abs(axes_[i].dot(offset)) >= limits[i]) return false;
    }
    return true;
  }
  [[nodiscard]] bool overlaps(const Box& box) const;

  /// Against a triangle, which may have no area.
  [[nodiscard]] bool overlaps(const std::array<Eigen::Vector3d, 3>& corners) const;

 private:
  Eigen::Vector3d center_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d half_;
  double touch_;
  /// Unit vectors: the box's three axes, the three of the frame, and the cross products of the two
  /// that are long enough to have a direction.
  std::array<Eigen::Vector3d, 15> axes_;
  std::array<double, 15> extent_{};  ///< half the box's length along each
  std::size_t axis_count_ = 0;
};

/// Whether boxes have a point in common, limits included.
[[nodiscard]] inline bool boxes_meet(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  }
  return true;
}

/// A binary tree over axis-aligned boxes, to find those near a place. Items are numbered as the
/// boxes were.
class BoxHierarchy {
 public:
  BoxHierarchy() = default;
  /// n log n for n boxes.
  explicit BoxHierarchy(std::vector<Box> boxes);

  /// Whether visit(item) is true for one of the boxes that meet `range`, limits included. Stops at
  /// the first.
  template <typename Visit>
  [[nodiscard]] bool any(const Box& range, const Visit& visit) const {
    return any_that([&range](const Box& box) { return boxes_meet(box, range); }, visit);
  }

  /// The same of the boxes that a half-line meets not beyond `end`, which visit may lower.
  template <typename Visit>
  [[nodiscard]] bool any_along(const HalfLine& line, const double& end, const Visit& visit) const {
    return any_that(
        [&](const Box& box) {
          const auto [first, last] = line.inside(box);
          return first <= last && last >= 0 && first <= end;
        },
        visit);
  }

 private:
  static constexpr std::size_t kMaxDepth = 64;  ///< halves of 2^32 items, one waiting a level

  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< the first of two children, or of `count` places in order_
    std::uint32_t count = 0;  ///< 0: an inner node
  };

  template <typename Meets, typename Visit>
  [[nodiscard]] bool any_that(const Meets& meets, const Visit& visit) const {
    if (nodes_.empty()) return false;
    std::array<std::uint32_t, kMaxDepth> stack{};
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!meets(node.box)) continue;
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = node.first + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (meets(boxes_[order_[i]]) && visit(order_[i])) return true;
      }
    }
    return false;
  }
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace viewgain::detail
