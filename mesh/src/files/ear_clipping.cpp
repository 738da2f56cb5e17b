// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "ear_clipping.hpp"

#include <algorithm>
#include <cmath>

namespace viewgain::detail {
namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t kMostCorners = 10'000;  // of one that is no fan: some seconds

Vector cross_product(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Twice the area of a triangle, positive if it turns to the left.
template <typename Flat>
double turn_of(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// How far c lies to the left of the line from a to b; 0 if that has no length.
template <typename Flat>
double left_of(const Flat& a, const Flat& b, const Flat& c) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  return length > 0 ? turn_of(a, b, c) / length : 0;
}

}  // namespace

bool EarClipping::split() {
  triangles_.clear();
  const double twice_area = flatten();
  if (add_fan()) return true;
  triangles_.clear();
  if (corners_.size() > kMostCorners) {
    reason_ = "has reflex corners among more than " + std::to_string(kMostCorners);
    return false;
  }
  reason_ = "crosses itself";
  return twice_area > no_area_ && !winds_ && !crosses_itself() && clip_all();
}

// Drops the axis along which the normal is longest: what lies inside stays inside.
double EarClipping::flatten() {
  const Vector first = corners_.front();
  Vector normal{};
  double extent = 0;
  for (Vector& p : corners_) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] -= first[k];
      extent = std::max(extent, std::abs(p[k]));
    }
  }
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    const Vector n = cross_product(corners_[i - 1], corners_[i]);
    for (std::size_t k = 0; k < 3; ++k) normal[k] += n[k];
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(x, y);
  flat_.clear();
  for (const Vector& p : corners_) flat_.push_back({p[x], p[y]});
  no_area_ = 1e-12 * extent * extent;
  slack_ = 1e-7 * extent;
  return std::abs(normal[axis]);
}

// True if the fan of the first corner fills the polygon, or that is a line. It does not where the
// others go round the first one more than once.
bool EarClipping::add_fan() {
  bool turns_left = true, is_back = false, was_beyond = false;
  winds_ = false;
  for (std::size_t i = 2; i < flat_.size(); ++i) {
    triangles_.push_back({0, i - 1, i});
    const double side = turn_of(flat_[0], flat_[1], flat_[i]);
    turns_left = turns_left && turn_of(flat_[0], flat_[i - 1], flat_[i]) > no_area_;
    is_back = is_back || (was_beyond && side > no_area_);
    winds_ = winds_ || (was_beyond && left_of(flat_[0], flat_[1], flat_[i]) > slack_);
    was_beyond = was_beyond || side < 0;
  }
  winds_ = winds_ && turns_left;
  return (turns_left && !is_back) || !has_area();
}

bool EarClipping::has_area() const {
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    for (const double n : cross_product(corners_[i - 1], corners_[i])) {
      if (std::abs(n) > no_area_) return true;
    }
  }
  return false;
}

bool EarClipping::crosses_itself() const {
  const auto parts = [this](const Flat& a, const Flat& b, const Flat& c, const Flat& d) {
    const double left = left_of(a, b, c), right = left_of(a, b, d);
    return (left > slack_ && right < -slack_) || (left < -slack_ && right > slack_);
  };
  const std::size_t count = flat_.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 2; j < count; ++j) {
      const Flat &a = flat_[i], &b = flat_[i + 1], &c = flat_[j], &d = flat_[(j + 1) % count];
      if (parts(a, b, c, d) && parts(c, d, a, b)) return true;
    }
  }
  return false;
}

// Its height over the line between its neighbours.
double EarClipping::height_at(std::size_t corner) const {
  return left_of(flat_[after_[corner]], flat_[before_[corner]], flat_[corner]);
}

bool EarClipping::is_ear(std::size_t corner) const {
  const Flat &a = flat_[before_[corner]], &b = flat_[corner], &c = flat_[after_[corner]];
  if (!(turn_of(a, b, c) > no_area_)) return false;
  for (std::size_t i = after_[after_[corner]]; i != before_[corner]; i = after_[i]) {
    const Flat& p = flat_[i];
    if (p == a || p == b || p == c) continue;
    if (left_of(a, b, p) >= -slack_ && left_of(b, c, p) >= -slack_ && left_of(c, a, p) >= -slack_) {
      return false;
    }
  }
  return true;
}

void EarClipping::clip(std::size_t corner) {
  const std::size_t a = before_[corner], c = after_[corner];
  triangles_.push_back({a, corner, c});
  after_[a] = c;
  before_[c] = a;
  is_ear_[a] = is_ear(a) ? 1 : 0;
  is_ear_[c] = is_ear(c) ? 1 : 0;
}

bool EarClipping::clip_all() {
  const std::size_t count = flat_.size();
  before_.resize(count);
  after_.resize(count);
  is_ear_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    before_[i] = (i + count - 1) % count;
    after_[i] = (i + 1) % count;
  }
  for (std::size_t i = 0; i < count; ++i) is_ear_[i] = is_ear(i) ? 1 : 0;
  std::size_t at = 0;
  for (std::size_t left = count; left > 3; --left) {
    const auto find = [&](auto&& is_wanted) {
      for (std::size_t seen = 0; seen < left; ++seen, at = after_[at]) {
        if (is_wanted(at)) return true;
      }
      return false;
    };
    // Where no ear is left, a corner in the middle of an edge, or at a spike, has no area to lose.
    if (!find([this](std::size_t i) { return is_ear_[i] != 0; }) &&
        !find([this](std::size_t i) { return std::abs(height_at(i)) <= slack_; })) {
      return false;
    }
    clip(at);
    at = after_[at];
  }
  triangles_.push_back({before_[at], at, after_[at]});
  return height_at(at) >= -slack_;
}

}  // namespace viewgain::detail
