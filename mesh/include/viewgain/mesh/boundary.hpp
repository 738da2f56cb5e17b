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

/// A closed chain of border edges, which are the edges with only one face. Let t be the direction
/// of an edge along the chain and n the outward normal of its face. Then t × n points away from the
/// surface: seen from outside, the surface lies to the left of t.
struct VIEWGAIN_EXPORT BoundaryLoop {
  std::vector<std::uint32_t> vertices;   ///< edge i: vertex i to i + 1, the last to vertex 0
  std::vector<std::uint32_t> triangles;  ///< face of edge i
};

/// A boundary run: consecutive edges of a loop that have the same BoundaryClass.
struct VIEWGAIN_EXPORT BoundaryRun {
  /// The image side at which the surface ends.
  BoundaryClass boundary_class = BoundaryClass::left;
  std::uint32_t loop = 0;  ///< index of the loop
  std::vector<std::uint32_t>
      vertices;  ///< in the order of the loop; one more than edges, unless `closed`
  std::vector<std::uint32_t> triangles;  ///< face of each edge
  bool closed = false;                   ///< whether the boundary run is the whole loop
  double length = 0;                     ///< length of the boundary run [m]
  std::uint32_t view = 0;  ///< index of the view by which most of its edges were classified
};

/// Settings of boundary_runs().
struct VIEWGAIN_EXPORT BoundaryConfig {
  /// Largest angle between face normal and line of sight at which a view sees a face [rad].
  double max_view_angle = 80.0 * std::numbers::pi / 180;
  /// Minimum length of a boundary run [m]. A shorter one is merged into the longer of its
  /// neighbours in the loop. Use several point spacings; otherwise each tooth of a jagged border
  /// becomes a boundary run.
  double min_run_length = 0;
  double min_loop_length = 0;  ///< shorter loops, such as small holes, are omitted [m]
};

/// The border of a surface as loops. Each border edge is in exactly one loop. At a vertex where
/// loops touch, they are separated by following the faces around the vertex. A loop starts at its
/// edge with the lowest triangle index, and loops are sorted by this index. Throws
/// Error(invalid_argument) for an index out of range, a number that is not finite, a wrong number
/// of normals, or an invalid edge. An edge is invalid if it has equal ends, more than two faces, or
/// two faces of inconsistent orientation. Throws Error(capacity) above 2^32 / 3 triangles. Cost:
/// O(n log n).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BoundaryLoop> boundary_loops(const SurfaceMesh& surface);

/// Cuts loops into boundary runs, in the order of the loops. The class of an edge is the direction
/// of t × n (BoundaryLoop) in the image of a view: left, right, top or bottom, whichever is
/// nearest. To smooth jagged borders, t × n is first averaged along the loop, over min_run_length
/// or a quarter of the loop, whichever is shorter.
///
/// This view is the last one that sees the midpoint of the edge. The midpoint must be within range,
/// its view angle below max_view_angle and, if `sees` is given, sees(view, point) true. If no view
/// sees it, the last view in front of the face is used; if there is none, the last view of all.
///
/// Boundary runs shorter than min_run_length are merged, shortest first. `views` are
/// T_world_camera, in the order in which they were taken. Throws Error(invalid_argument) without
/// views, and for an invalid view, sensor, loop or config. Cost: O(edges · views).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BoundaryRun> boundary_runs(
    const SurfaceMesh& surface, std::span<const BoundaryLoop> loops, std::span<const Pose> views,
    const Sensor& sensor, const BoundaryConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
