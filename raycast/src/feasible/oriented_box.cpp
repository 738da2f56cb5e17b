// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oriented_box.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace viewgain::detail {
namespace {

// Shorter cross products of unit vectors have no reliable direction. The edges are then parallel,
// and the axes of the faces suffice.
constexpr double kParallel = 1e-7;

Eigen::Vector3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

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

OrientedBox::OrientedBox(const Eigen::Vector3d& center, const Eigen::Matrix3d& R,
                         const Eigen::Vector3d& half, double touch)
    : center_(center), R_(R), half_(half), touch_(touch) {
  const auto add = [this](const Eigen::Vector3d& axis) {
    axes_[axis_count_] = axis;
    extent_[axis_count_] = (R_.transpose() * axis).cwiseAbs().dot(half_);
    ++axis_count_;
  };
  for (int i = 0; i < 3; ++i) add(R.col(i));
  for (int i = 0; i < 3; ++i) add(Eigen::Vector3d::Unit(i));
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d cross = R.col(i).cross(Eigen::Vector3d::Unit(k));
      if (cross.norm() > kParallel) add(cross.normalized());
    }
  }
}

Box OrientedBox::bounds() const {
  const Eigen::Vector3d reach = R_.cwiseAbs() * half_;
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    box.min[k] = center_[axis] - reach[axis];
    box.max[k] = center_[axis] + reach[axis];
  }
  return box;
}

OrientedBox::Limits OrientedBox::limits(const Eigen::Vector3d& half_other) const {
  Limits limits{};
  for (std::size_t i = 0; i < axis_count_; ++i) {
    limits[i] = extent_[i] + axes_[i].cwiseAbs().dot(half_other) - touch_;
  }
  return limits;
}

bool OrientedBox::overlaps(const Box& box) const {
  const Eigen::Vector3d low = vector(box.min), high = vector(box.max);
  return overlaps(0.5 * (low + high), limits(0.5 * (high - low)));
}

bool OrientedBox::overlaps(const std::array<Eigen::Vector3d, 3>& corners) const {
  // In the box's frame.
  std::array<Eigen::Vector3d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = R_.transpose() * (corners[i] - center_);
  const auto separates = [&](const Eigen::Vector3d& axis) {
    const double length = axis.norm();
    if (!(length > 0)) return false;
    const double a = axis.dot(p[0]), b = axis.dot(p[1]), c = axis.dot(p[2]);
    const double extent = axis.cwiseAbs().dot(half_) - touch_ * length;
    return std::min({a, b, c}) >= extent || std::max({a, b, c}) <= -extent;
  };
  for (int k = 0; k < 3; ++k) {
    if (separates(Eigen::Vector3d::Unit(k))) return false;
  }
  const std::array<Eigen::Vector3d, 3> edges{p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  if (separates(edges[0].cross(edges[1]))) return false;
  for (const Eigen::Vector3d& edge : edges) {
    for (int k = 0; k < 3; ++k) {
      if (separates(Eigen::Vector3d::Unit(k).cross(edge))) return false;
    }
  }
  return true;
}

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
