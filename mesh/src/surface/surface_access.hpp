// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "viewgain/mesh/surface.hpp"

namespace viewgain::detail {

/// Plain arrays as vectors.
[[nodiscard]] inline Eigen::Vector3d vector(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}
[[nodiscard]] inline Eigen::Vector3d position(const SurfaceMesh& surface, std::uint32_t vertex) {
  return vector(surface.vertices[vertex]);
}
[[nodiscard]] inline Eigen::Vector3d normal(const SurfaceMesh& surface, std::uint32_t vertex) {
  return vector(surface.normals[vertex]);
}

/// Throws Error(invalid_argument) naming the value if a triangle's index is out of range, a
/// coordinate is not finite, or there is not one normal per vertex.
void check_surface(const SurfaceMesh& surface);

}  // namespace viewgain::detail
