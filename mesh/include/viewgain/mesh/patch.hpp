// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain {

/// w = a u² + b uv + c v² + d u + e v + f in a local frame: u outward across the boundary, v along
/// it, w along the normal. The lengths origin, u, v and w are in metres. Members check nothing.
struct VIEWGAIN_EXPORT QuadraticPatch {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< world
  /// Columns u, v, w in the world; right-handed. By columns in memory, whatever a program's Eigen
  /// does by default.
  Eigen::Matrix<double, 3, 3, Eigen::ColMajor> axes = Eigen::Matrix3d::Identity();
  std::array<double, 6> coefficients{};  ///< a b c d e f
  bool planar = false;                   ///< the points did not determine a quadric: a = b = c = 0
  double rms = 0;                        ///< of the residuals along w [m]
  double depth = 0;                      ///< how far inward the fitted points reach: -min u [m]

  /// World point [m] at (u, v) [m].
  [[nodiscard]] Eigen::Vector3d point(double u, double v) const;
  /// Unit normal at (u, v) [m], in the world, on the side of +w.
  [[nodiscard]] Eigen::Vector3d normal(double u, double v) const;
};

/// Least squares over the points [m], in any order, in the frame with this origin [m], u and w made
/// orthonormal to the direction `normal` [1] (w = normal, u = the part of the direction `outward`
/// [1] across it, v = w × u); all of them in the world. The quadric needs 7 points, a condition
/// number, of the design matrix in units of the points' spread, under 1e3, and residuals that leave
/// the slope dw/du at u = depth, v = 0, where an extrapolation may end, a standard deviation of at
/// most 0.2; else a plane; with fewer than 3 points, or points on a line, the plane w = 0. Throws
/// Error(invalid_argument) if outward is parallel to normal or a number is not finite. Costs
/// O(points).
[[nodiscard]] VIEWGAIN_EXPORT QuadraticPatch fit_patch(std::span<const Eigen::Vector3d> points,
                                                       const Eigen::Vector3d& origin,
                                                       const Eigen::Vector3d& outward,
                                                       const Eigen::Vector3d& normal);

/// Vertices of the surface within `depth` [m] of the seeds along edges (Dijkstra), that turn by
/// less than `max_turn` [rad] from the seeds' mean normal: the region of step 4. Rising order; none
/// if the seeds' normals cancel. Throws Error(invalid_argument) for an index out of range, a number
/// that is not finite, or if there is not one normal a vertex. Cost: a pass over the surface, and
/// O(n log n) of the vertices that are reached.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::uint32_t> grow_region(
    const SurfaceMesh& surface, std::span<const std::uint32_t> seeds, double depth,
    double max_turn);

}  // namespace viewgain
