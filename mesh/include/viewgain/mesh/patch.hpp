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

/// A patch: a quadric that is fitted to a surface near its boundary, to extrapolate the surface. In
/// a local frame [m], w = a u² + b uv + c v² + d u + e v + f, where u points outward across the
/// boundary, v along the boundary and w along the surface normal. Arguments are not checked.
struct VIEWGAIN_EXPORT QuadraticPatch {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< origin of the local frame, world [m]
  /// Columns: the axes u, v, w in the world frame, right-handed. Stored column-major.
  Eigen::Matrix<double, 3, 3, Eigen::ColMajor> axes = Eigen::Matrix3d::Identity();
  std::array<double, 6> coefficients{};  ///< a, b, c, d, e, f
  /// Whether a plane was fitted instead, because the points did not determine a quadric.
  bool planar = false;
  double rms = 0;    ///< root mean square of the residuals along w [m]
  double depth = 0;  ///< inward extent of the fitted points, -min u [m]

  /// Point of the patch at (u, v) [m], world frame [m].
  [[nodiscard]] Eigen::Vector3d point(double u, double v) const;
  /// Unit normal of the patch at (u, v) [m], world frame, on the side of +w.
  [[nodiscard]] Eigen::Vector3d normal(double u, double v) const;
};

/// Least-squares fit of a patch to points. All arguments are in the world frame [m]. The local
/// frame has its origin at `origin`. w points along `normal`, u along the part of `outward` that is
/// perpendicular to `normal`, and v = w × u. The vectors may have any length. Fits a quadric if 7
/// or more points determine it well, otherwise a plane. If there are fewer than 3 points, or all
/// are collinear, the result is the plane w = 0. Throws Error(invalid_argument) if outward is
/// parallel to normal or a number is not finite. Cost: O(points).
[[nodiscard]] VIEWGAIN_EXPORT QuadraticPatch fit_patch(std::span<const Eigen::Vector3d> points,
                                                       const Eigen::Vector3d& origin,
                                                       const Eigen::Vector3d& outward,
                                                       const Eigen::Vector3d& normal);

/// The region of a surface around the vertices `seeds`, in increasing order. Its vertices are at
/// most `depth` [m] from a seed, measured along edges. Their normals differ from the mean normal of
/// the seeds by less than `max_turn` [rad]. Empty if the normals of the seeds cancel. Throws
/// Error(invalid_argument) for an index out of range, a number that is not finite or a wrong number
/// of normals. Cost: one pass over the surface, and O(n log n) for n vertices in the region.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<std::uint32_t> grow_region(
    const SurfaceMesh& surface, std::span<const std::uint32_t> seeds, double depth,
    double max_turn);

}  // namespace viewgain
