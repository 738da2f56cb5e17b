// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace viewgain::detail {

/// Coordinates of 52 bits, so that the predicates below are exact.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  bool operator==(const GridPoint&) const = default;
};

__extension__ using Wide = __int128;

/// Points and edges nearer than this are merged [grid units]; it is 1e-12 of the polygon. Otherwise
/// edges that coincide except for rounding would create ever more crossings.
inline constexpr double kNear = 1024;

inline int sign_of(Wide x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Twice the area of a triangle, positive if it is counter-clockwise. Differences have 53 bits.
inline Wide turn_of(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return Wide{b.x - a.x} * (c.y - a.y) - Wide{b.y - a.y} * (c.x - a.x);
}

/// Whether p lies inside the circle through a, b, c, which are counter-clockwise. Adds products of
/// two numbers of 107 bits in digits of 52 bits.
inline bool is_in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c,
                         const GridPoint& p) {
  constexpr int kDigit = 52;
  constexpr Wide kMask = (Wide{1} << kDigit) - 1;
  Wide high = 0, middle = 0, low = 0;
  const auto add = [&](const GridPoint& q, const GridPoint& r, const GridPoint& s) {
    const Wide x = q.x - p.x, y = q.y - p.y;
    const Wide square = x * x + y * y, turn = turn_of(p, r, s);
    const Wide s1 = square >> kDigit, s0 = square & kMask;
    const Wide t1 = turn >> kDigit, t0 = turn & kMask;
    high += s1 * t1;
    middle += s1 * t0 + s0 * t1;
    low += s0 * t0;
  };
  add(a, b, c);
  add(b, c, a);
  add(c, a, b);
  middle += low >> kDigit;
  high += middle >> kDigit;
  return high > 0 || (high == 0 && ((middle & kMask) != 0 || (low & kMask) != 0));
}

inline double distance(const GridPoint& a, const GridPoint& b) {
  const auto x = static_cast<double>(b.x - a.x), y = static_cast<double>(b.y - a.y);
  return std::sqrt(x * x + y * y);
}

/// Whether p lies almost on the segment from a to b, but not at its ends.
inline bool is_on_way(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  const double length = distance(a, b);
  if (std::abs(static_cast<double>(turn_of(a, b, p))) > kNear * length) return false;
  const double along =
      static_cast<double>(Wide{p.x - a.x} * (b.x - a.x) + Wide{p.y - a.y} * (b.y - a.y)) / length;
  return along > kNear && along < length - kNear;
}

}  // namespace viewgain::detail
