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

/// Triangles of the surface through points by CGAL's advancing front over their Delaunay
/// triangulation, none with an edge over the longer of its ends' `max_edge`, one a point;
/// consistently oriented in each component, the side being arbitrary. Each begins with its lowest
/// vertex, and they are sorted. The points should be about 1 apart, as CGAL has absolute
/// tolerances. The same points give the same triangles but for the side of a component.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> advancing_front(
    std::span<const Point3> points, std::span<const double> max_edge, const ExecConfig& exec);

}  // namespace viewgain::detail
