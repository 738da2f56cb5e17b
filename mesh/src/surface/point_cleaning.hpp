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

/// Indices, rising, of the points that lie in a component of at least min_component points; points
/// within join_distance spacings of either are in one component.
[[nodiscard]] std::vector<std::uint32_t> large_components(std::span<const OrientedPoint> points,
                                                          const SurfaceConfig& config);

/// The points, moved onto the quadric that is fitted to their neighbours on the same side (jet
/// smoothing). A point whose neighbours agree on a surface that is more than 1.25 spacings away is
/// no point of the surface: it gets NaNs. Without enough neighbours for a fit a point stays.
[[nodiscard]] std::vector<Point3> smoothed(std::span<const OrientedPoint> points,
                                           const SurfaceConfig& config, const ExecConfig& exec);

/// Indices, rising, of points that are at least min_distance apart; of two that are nearer the
/// earlier one stays. Points that are NaN are left out.
[[nodiscard]] std::vector<std::uint32_t> apart(std::span<const Point3> points, double min_distance);

}  // namespace viewgain::detail
