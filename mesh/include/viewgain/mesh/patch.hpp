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

/// Patch w = a u² + b uv + c v² + d u + e v + f in a local frame [m]. The axis u points outward
/// across the boundary, v along the boundary, and w along the normal. Members check nothing.
struct VIEWGAIN_EXPORT QuadraticPatch {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< world
  /// Columns u, v, w in the world; right-handed. Stored column-major.
  Eigen::Matrix<double, 3, 3, Eigen::ColMajor> axes = Eigen::Matrix3d::Identity();
  std::array<double, 6> coefficients{};  ///< a b c d e f
  /// Whether a plane was fitted, because the points did not determine a quadric.
  bool planar = false;
  double rms = 0;    ///< root mean square of the residuals along w [m]
  double depth = 0;  ///< inward extent of the fitted points: -min u [m]

  /// World point [m] at (u, v) [m].
  [[nodiscard]] Eigen::Vector3d point(double u, double v) const;
  /// Unit normal at (u, v) [m], world frame, on the side of +w.
  [[nodiscard]] Eigen::Vector3d normal(double u, double v) const;
};

/// Least-squares fit to the points [m], world frame. The local frame has this origin [m]. w points
/// along `normal`, u along the part of `outward` that is perpendicular to `normal`, and v = w × u.
/// Neither vector needs unit length. A quadric is fitted to 7 or more points that determine it
/// well. Otherwise a plane is fitted. If there are fewer than 3 points, or all are collinear, the
/// result is the plane w = 0. Throws Error(invalid_argument) if outward is parallel to normal or a
/// number is not finite. Cost: O(points).
[[nodiscard]] VIEWGAIN_EXPORT QuadraticPatch fit_patch(std::span<const Eigen::Vector3d> points,
                                                       const Eigen::Vector3d& origin,
                                                       const Eigen::Vector3d& outward,
                                                       const Eigen::Vector3d& normal);

/// Vertices near the seeds. Their distance from a seed, measured along edges (Dijkstra), is at most
/// `depth` [m]. Their normals differ by less than `max_turn` [rad] from the seeds' mean normal. The
/// result is in increasing order, and empty if the seeds' normals cancel. Throws
/// Error(invalid_argument) for an index out of range, a number that is not finite or a wrong number
/// of normals. Cost: one pass over the surface, and O(n log n) for n reached vertices.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::uint32_t> grow_region(
    const SurfaceMesh& surface, std::span<const std::uint32_t> seeds, double depth,
    double max_turn);

}  // namespace viewgain
