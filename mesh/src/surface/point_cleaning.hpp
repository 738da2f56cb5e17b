// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "point_grid.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain::detail {

[[nodiscard]] std::vector<Point3> positions_of(std::span<const OrientedPoint> points);

/// The point's own spacing [m].
[[nodiscard]] inline double spacing_at(const OrientedPoint& point, const SurfaceConfig& config) {
  return point.spacing > 0 ? point.spacing : config.spacing;
}

/// Ascending indices of the points in components of at least min_component points. Points are in
/// one component if they are within join_distance spacings of either point.
[[nodiscard]] std::vector<std::uint32_t> large_components(std::span<const OrientedPoint> points,
                                                          const SurfaceConfig& config);

/// The points, moved onto the quadric that is fitted to their neighbours on the same side (jet
/// smoothing). A point that would move by more than 1.25 spacings is not on the surface and becomes
/// NaN. Without enough neighbours for a fit a point stays.
[[nodiscard]] std::vector<Point3> smoothed(std::span<const OrientedPoint> points,
                                           const SurfaceConfig& config, const ExecConfig& exec);

/// Ascending indices of points that are at least min_distance apart; of two nearer points the
/// earlier one is kept. Omits points that are NaN.
[[nodiscard]] std::vector<std::uint32_t> apart(std::span<const Point3> points, double min_distance);

}  // namespace viewgain::detail
