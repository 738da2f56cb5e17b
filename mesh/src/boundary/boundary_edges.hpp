// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/mesh/surface.hpp"

namespace viewgain::detail {

/// A border edge with its face.
struct BoundaryEdge {
  Eigen::Vector3d middle;   ///< [m]
  Eigen::Vector3d normal;   ///< of the face; zero if it has no area
  Eigen::Vector3d outward;  ///< conormal t × n, unit; zero if it is not defined
  double length;            ///< [m]
};

/// The edges of a chain of vertices, one per triangle; a closed chain returns to its first vertex.
/// Throws Error(invalid_argument) if the sizes or an index do not fit the surface.
[[nodiscard]] std::vector<BoundaryEdge> boundary_edges(const SurfaceMesh& surface,
                                                       std::span<const std::uint32_t> vertices,
                                                       std::span<const std::uint32_t> triangles,
                                                       bool closed);

}  // namespace viewgain::detail
