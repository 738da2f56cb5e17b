// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_makers.hpp"

#include <cmath>
#include <numbers>

namespace viewgain::test {

TriangleMesh square(double half, double height) {
  TriangleMesh mesh;
  mesh.vertices = {
      {-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

TriangleMesh sphere(double radius, int rings) {
  TriangleMesh mesh;
  const int sectors = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    const double polar = std::numbers::pi * i / rings;
    for (int k = 0; k < sectors; ++k) {
      const double azimuth = 2 * std::numbers::pi * k / sectors;
      mesh.vertices.push_back({radius * std::sin(polar) * std::cos(azimuth),
                               radius * std::sin(polar) * std::sin(azimuth),
                               radius * std::cos(polar)});
    }
  }
  const auto vertex = [&](int ring, int sector) {
    return static_cast<std::uint32_t>(ring * sectors + sector % sectors);
  };
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < sectors; ++k) {
      if (i > 0) mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i, k + 1)});
      if (i + 1 < rings) {
        mesh.triangles.push_back({vertex(i, k + 1), vertex(i + 1, k), vertex(i + 1, k + 1)});
      }
    }
  }
  return mesh;
}

}  // namespace viewgain::test
