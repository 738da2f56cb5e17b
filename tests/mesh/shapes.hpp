// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "support/meshes.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain::test {

/// Numbers that are the same on every machine.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 0xD1B54A32D192ED03ULL) {}

  /// In (0, 1).
  double uniform() {
    const std::uint64_t h = mix64(state_);
    state_ += kMixStep;
    return (static_cast<double>(h >> 11U) + 0.5) * 0x1.0p-53;
  }
  /// Standard normal, by Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

inline double norm(const std::array<double, 3>& p) { return std::hypot(p[0], p[1], p[2]); }

/// Fibonacci points on a sphere, about `spacing` apart, moved along the radius by Gaussian noise;
/// only those with z over min_z · radius. The hints are the outward normals.
inline std::vector<OrientedPoint> sphere_points(double radius, double spacing, double sigma = 0,
                                                double min_z = -2,
                                                std::array<double, 3> center = {}) {
  const auto count =
      static_cast<std::size_t>(4 * std::numbers::pi * radius * radius / (spacing * spacing));
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  Noise noise(7);
  std::vector<OrientedPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double azimuth = golden * static_cast<double>(i), r = std::sqrt(1 - z * z);
    const std::array<double, 3> n{r * std::cos(azimuth), r * std::sin(azimuth), z};
    const double range = radius + sigma * noise.normal();
    if (z <= min_z) continue;
    OrientedPoint p{{}, n};
    for (std::size_t k = 0; k < 3; ++k) p.position[k] = center[k] + range * n[k];
    points.push_back(p);
  }
  return points;
}

/// A square lattice of side × side points in the plane z, seen from the side `up` (+1 or -1).
inline std::vector<OrientedPoint> plate_points(int side, double spacing, double z = 0,
                                               double up = 1) {
  std::vector<OrientedPoint> points;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) points.push_back({{i * spacing, j * spacing, z}, {0, 0, up}});
  }
  return points;
}

/// The square [0, side]² in the plane z = 0, normal +z.
inline TriangleMesh plate_mesh(double side) {
  return {{{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace viewgain::test
