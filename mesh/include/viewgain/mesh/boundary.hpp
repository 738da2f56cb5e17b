// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "viewgain/core/boundary_class.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain {

/// A closed chain of border edges. Seen from outside, the surface lies to the left of the direction
/// of travel t. If n is the normal of an edge's face, t × n points away from the surface.
struct VIEWGAIN_EXPORT BoundaryLoop {
  std::vector<std::uint32_t> vertices;   ///< edge i goes from vertex i to vertex i + 1 (cyclic)
  std::vector<std::uint32_t> triangles;  ///< the face of edge i
};

/// A boundary run: a part of a loop whose edges have one class.
struct VIEWGAIN_EXPORT BoundaryRun {
  /// Image side at which the surface ends.
  BoundaryClass boundary_class = BoundaryClass::left;
  std::uint32_t loop = 0;  ///< index of its loop
  std::vector<std::uint32_t>
      vertices;  ///< in the order of the loop: one more than edges, unless closed
  std::vector<std::uint32_t> triangles;  ///< the face of each edge
  bool closed = false;                   ///< the boundary run is the whole loop
  double length = 0;                     ///< [m]
  std::uint32_t view = 0;                ///< the view whose image axes classify most of its edges
};

/// Settings for cutting loops into boundary runs.
struct VIEWGAIN_EXPORT BoundaryConfig {
  /// Largest angle between face normal and line of sight [rad].
  double max_view_angle = 80.0 * std::numbers::pi / 180;
  /// Minimum length of a boundary run [m]. A shorter one joins the longer of its neighbours in the
  /// loop. Use several point spacings; otherwise each tooth of a jagged border is a boundary run.
  double min_run_length = 0;
  double min_loop_length = 0;  ///< shorter loops are omitted: small holes [m]
};

/// The border of the surface: every border edge is in exactly one loop. Loops that touch at a
/// vertex are separated by following the faces around it. A loop starts at its edge with the lowest
/// triangle index, and loops are sorted by this index. Throws Error(invalid_argument) for an index
/// out of range, a number that is not finite, a wrong number of normals, or an invalid edge. An
/// edge is invalid if both of its ends are the same vertex, if it has more than two faces, or if
/// its two faces have inconsistent orientation. Throws Error(capacity) above 2^32 / 3 triangles.
/// O(n log n).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BoundaryLoop> boundary_loops(const SurfaceMesh& surface);

/// Cuts loops into boundary runs. Let t be the direction of an edge and n the normal of its face;
/// t × n then points outward, across the edge. The edge's class is the direction of t × n in the
/// image of a view: left, right, top or bottom, whichever is nearest. To smooth jagged borders,
/// these vectors are first averaged along the loop, over min_run_length or a quarter of the loop,
/// whichever is shorter.
///
/// The view is the last one that shows the edge's midpoint within range, at less than
/// max_view_angle and, if `sees`(view, point) is given, unoccluded. If there is none, it is the
/// last view in front of the face. If there is none of these either, it is the last view.
///
/// Boundary runs shorter than min_run_length join the longer neighbour, shortest first. The result
/// follows the order of the loops. Throws Error(invalid_argument) if there are no views, or a view,
/// the sensor, a loop or the config is invalid. Cost: O(edges · views).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BoundaryRun> boundary_runs(
    const SurfaceMesh& surface, std::span<const BoundaryLoop> loops, std::span<const Pose> views,
    const Sensor& sensor, const BoundaryConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
