// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "point_grid.hpp"
#include "viewgain/core/exec_config.hpp"

namespace viewgain::detail {

/// Triangles of the surface through points, by CGAL's advancing front over their Delaunay
/// triangulation. An edge is at most as long as the larger `max_edge` of its ends; there is one
/// value per point. Each component is oriented consistently, on an arbitrary side; except for that
/// side, equal points give equal triangles. A triangle begins with its lowest vertex, and triangles
/// are sorted. The points should be about 1 apart, because CGAL has absolute tolerances.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> advancing_front(
    std::span<const Point3> points, std::span<const double> max_edge, const ExecConfig& exec);

}  // namespace viewgain::detail
