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

/// A closed chain of border edges. Consecutive vertices follow the *face's* halfedges, so that the
/// surface lies to the left of the direction of travel seen from outside and t × n points out of
/// it.
struct VIEWGAIN_EXPORT BoundaryLoop {
  std::vector<std::uint32_t> vertices;   ///< edge i goes from vertex i to vertex i + 1 (cyclic)
  std::vector<std::uint32_t> triangles;  ///< the face of edge i
};

/// A piece of a loop whose edges have one class.
struct VIEWGAIN_EXPORT BoundaryRun {
  BoundaryClass boundary_class = BoundaryClass::left;  ///< the image side to which the surface ends
  std::uint32_t loop = 0;                              ///< which one it is a part of
  std::vector<std::uint32_t> vertices;  ///< in the loop's order: one more than edges, unless closed
  std::vector<std::uint32_t> triangles;  ///< the face of each edge
  bool closed = false;                   ///< the whole loop is one run
  double length = 0;                     ///< [m]
  std::uint32_t view = 0;  ///< the view in whose axes it is classified (the most common)
};

/// How a boundary is cut into runs.
struct VIEWGAIN_EXPORT BoundaryConfig {
  /// Between face normal and line of sight [rad].
  double max_view_angle = 80.0 * std::numbers::pi / 180;
  double min_run_length = 0;   ///< shorter runs join the longer neighbour in their loop [m]; some
                               ///< spacings, or each tooth of a jagged border is a run
  double min_loop_length = 0;  ///< shorter loops are left out: small holes [m]
};

/// The border of the surface. Every border edge is in exactly one loop; where loops touch in a
/// vertex they are separated by following the faces round it. Loops begin at their edge of lowest
/// triangle and are in that order. Throws Error(invalid_argument) for an index out of range, a
/// number that is not finite, not one normal a vertex, or an edge with one vertex at both ends,
/// more than two faces, or two that turn differently; Error(capacity) beyond 2^32 / 3 triangles.
/// O(n log n).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BoundaryLoop> boundary_loops(const SurfaceMesh& surface);

/// Cuts loops into runs. The class of an edge is that of its outward conormal t × n (t along the
/// face's halfedge, n the face's normal) in the image axes of the last view (T_world_camera) that
/// has the edge's midpoint in its image and range limits at under max_view_angle: the largest of
/// its components to -x left, +x right, -y top, +y bottom. `sees`, if given, is asked as well
/// (view, point, is it unoccluded). Edges that no view sees take the class in the last view that
/// stands before their face at under 90°, or the last view. Runs shorter than min_run_length join
/// the longer neighbour, the shortest first; so that a jagged border is classed by its course,
/// conormals are averaged before that along min_run_length of the loop (at most a quarter of it).
/// Each loop that is not left out has each of its edges in one run. Runs are in the order of the
/// loops and along them. Throws Error(invalid_argument) if there are no views, or a view, the
/// sensor, a loop or the config is not valid. Costs O(edges · views).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<BoundaryRun> boundary_runs(
    const SurfaceMesh& surface, std::span<const BoundaryLoop> loops, std::span<const Pose> views,
    const Sensor& sensor, const BoundaryConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
