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

/// Checks a box of any orientation against axis-aligned boxes and triangles, by separating axes:
/// exact except for rounding. Overlaps of less than `touch` along an axis count as touching. All
/// lengths are in the same unit, whichever it is.
class OrientedBox {
 public:
  /// Columns of R: the box's axes, orthonormal; `half`: half its size along them.
  OrientedBox(const Eigen::Vector3d& center, const Eigen::Matrix3d& R, const Eigen::Vector3d& half,
              double touch);

  /// The axis-aligned bounding box.
  [[nodiscard]] Box bounds() const;

  /// For each axis, the distance between centres from which on a box of this half size is
  /// separated. For testing many boxes of one size.
  using Limits = std::array<double, 15>;
  [[nodiscard]] Limits limits(const Eigen::Vector3d& half_other) const;

  /// Checks an axis-aligned box with the size of the limits.
  [[nodiscard]] bool overlaps(const Eigen::Vector3d& center_other, const Limits& limits) const {
    const Eigen::Vector3d offset = center_other - center_;
    for (std::size_t i = 0; i < axis_count_; ++i) {
      if (std::abs(axes_[i].dot(offset)) >= limits[i]) return false;
    }
    return true;
  }
  [[nodiscard]] bool overlaps(const Box& box) const;

  /// Checks a triangle, which may have no area.
  [[nodiscard]] bool overlaps(const std::array<Eigen::Vector3d, 3>& corners) const;

 private:
  Eigen::Vector3d center_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d half_;
  double touch_;
  /// Unit vectors: the three axes of the box, the three of the frame, and their cross products, if
  /// these are long enough.
  std::array<Eigen::Vector3d, 15> axes_;
  std::array<double, 15> extent_{};  ///< half the box's extent along each
  std::size_t axis_count_ = 0;
};

/// Whether boxes share a point, including their faces.
[[nodiscard]] inline bool boxes_meet(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  }
  return true;
}

/// A binary tree over axis-aligned boxes, to find boxes near a position. Items have the indices of
/// the boxes.
class BoxHierarchy {
 public:
  BoxHierarchy() = default;
  /// Cost: O(n log n) for n boxes.
  explicit BoxHierarchy(std::vector<Box> boxes);

  /// Whether visit(item) is true for one of the boxes that touch `range`. Stops at the first.
  template <typename Visit>
  [[nodiscard]] bool any(const Box& range, const Visit& visit) const {
    return any_that([&range](const Box& box) { return boxes_meet(box, range); }, visit);
  }

  /// As above for the boxes that a half-line hits before `end`, which visit may lower.
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
  static constexpr std::size_t kMaxDepth = 64;  ///< for 2^32 items, one pending node per level

  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< first of two children, or of `count` entries in order_
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
