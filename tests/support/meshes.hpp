// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::test {

/// A sphere round the origin of latitude bands and twice as many sectors, its vertices on the
/// sphere, faces outward. Radius [m].
inline TriangleMesh sphere_mesh(double radius, std::uint32_t bands) {
  TriangleMesh mesh;
  const std::uint32_t columns = 2 * bands;
  for (std::uint32_t i = 0; i <= bands; ++i) {
    const double polar = std::numbers::pi * i / bands;
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double azimuth = 2 * std::numbers::pi * j / columns;
      mesh.vertices.push_back({radius * std::sin(polar) * std::cos(azimuth),
                               radius * std::sin(polar) * std::sin(azimuth),
                               radius * std::cos(polar)});
    }
  }
  for (std::uint32_t i = 0; i < bands; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t a = i * columns + j, b = i * columns + (j + 1) % columns;
      if (i > 0) mesh.triangles.push_back({a, a + columns, b});
      if (i + 1 < bands) mesh.triangles.push_back({b, a + columns, b + columns});
    }
  }
  return mesh;
}

/// A cube round the origin, [-half, half] along each axis [m], faces outward.
inline TriangleMesh cube_mesh(double half) {
  TriangleMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto at = [&](unsigned axis) { return (corner >> axis & 1U) != 0 ? half : -half; };
    mesh.vertices.push_back({at(0), at(1), at(2)});
  }
  for (const std::array<std::uint32_t, 4>& f : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                                                {4, 5, 7, 6},
                                                {0, 1, 5, 4},
                                                {2, 6, 7, 3},
                                                {0, 4, 6, 2},
                                                {1, 3, 7, 5}}) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

/// A square of half-width `half` [m] in the plane z = height [m], normal -z.
inline TriangleMesh square_mesh(double half, double height) {
  return {
      {{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}},
      {{0, 2, 1}, {0, 3, 2}}};
}

}  // namespace viewgain::test
