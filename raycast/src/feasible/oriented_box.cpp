// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oriented_box.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace viewgain::detail {
namespace {

// Shorter cross products of unit vectors have no direction to speak of; the edges are parallel and
// the faces' axes decide.
constexpr double kParallel = 1e-7;

Eigen::Vector3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

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

}  // namespace viewgain::detail
