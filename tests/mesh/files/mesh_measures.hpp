// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::test {

using Point = std::array<double, 3>;

inline Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Of twice the area's length.
inline Point normal_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  return cross(minus(mesh.vertices[t[1]], mesh.vertices[t[0]]),
               minus(mesh.vertices[t[2]], mesh.vertices[t[0]]));
}

struct Measures {
  double area = 0, volume = 0;
};

inline Measures measures_of(const TriangleMesh& mesh) {
  Measures m;
  for (const auto& t : mesh.triangles) {
    const Point normal = normal_of(mesh, t);
    m.area += std::sqrt(dot(normal, normal)) / 2;
    m.volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) / 6;
  }
  return m;
}

}  // namespace viewgain::test
