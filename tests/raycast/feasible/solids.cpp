// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "solids.hpp"

namespace viewgain::test {
namespace {

// The part of a polygon with n · p < d (Sutherland and Hodgman).
Polygon cut(const Polygon& polygon, const Eigen::Vector3d& n, double d) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double from = n.dot(a) - d, to = n.dot(b) - d;
    if (from < 0) kept.push_back(a);
    if ((from < 0) != (to < 0)) kept.push_back(a + (b - a) * (from / (from - to)));
  }
  return kept;
}

bool has_face_in(const Solid& a, const Solid& b) {
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d u = a.axes.col((k + 1) % 3) * a.half[(k + 1) % 3];
    const Eigen::Vector3d v = a.axes.col((k + 2) % 3) * a.half[(k + 2) % 3];
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d middle = a.center + side * a.half[k] * a.axes.col(k);
      if (reaches_into({middle - u - v, middle + u - v, middle + u + v, middle - u + v}, b)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

Solid Solid::of(const Box& box) {
  const Eigen::Vector3d low(box.min[0], box.min[1], box.min[2]);
  const Eigen::Vector3d high(box.max[0], box.max[1], box.max[2]);
  return {0.5 * (low + high), Eigen::Matrix3d::Identity(), 0.5 * (high - low)};
}

bool Solid::contains(const Eigen::Vector3d& p) const {
  return ((axes.transpose() * (p - center)).cwiseAbs().array() < half.array()).all();
}

bool reaches_into(Polygon polygon, const Solid& solid) {
  for (int k = 0; k < 3 && !polygon.empty(); ++k) {
    const Eigen::Vector3d n = solid.axes.col(k);
    polygon = cut(polygon, n, n.dot(solid.center) + solid.half[k]);
    polygon = cut(polygon, -n, -n.dot(solid.center) + solid.half[k]);
  }
  return !polygon.empty();
}

bool overlap(const Solid& a, const Solid& b) { return has_face_in(a, b) || has_face_in(b, a); }

}  // namespace viewgain::test
