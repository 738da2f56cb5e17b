// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "constrained_triangulation.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::detail {

/// Splits polygons in space into triangles: a fan of the first corner if that fills the polygon,
/// else a constrained triangulation. Projects a polygon along the axis nearest to its normal, so it
/// need not be exactly plane. Fills all places with a winding number other than 0; a hole joined to
/// the rim stays open.
class PolygonFill {
 public:
  /// Adds the triangles of a polygon of three corners or more to the mesh, and a vertex where edges
  /// cross. Triangles without area are omitted, so there may be none. Triangles have the polygon's
  /// orientation around them. True if the polygon crosses itself by more than rounding. Throws
  /// Error(format) about the face if the budget is used up.
  [[nodiscard]] bool fill(std::span<const std::uint32_t> corners, TriangleMesh& mesh,
                          FillBudget& budget);

 private:
  using Point = std::array<double, 3>;
  struct Flat {
    double x, y;
  };

  void take(std::span<const std::uint32_t> corners, const TriangleMesh& mesh);
  void flatten();
  [[nodiscard]] bool is_fan() const;
  [[nodiscard]] bool has_area() const;
  [[nodiscard]] bool triangulate(TriangleMesh& mesh, FillBudget& budget);

  std::vector<std::uint32_t> corners_;  // without repeated positions
  std::vector<Point> points_;           // relative to the first one
  Point first_{};
  std::vector<Flat> flat_;
  double extent_ = 0;   // the largest coordinate
  double no_area_ = 0;  // twice an area that counts as zero because of rounding
  std::vector<GridPoint> grid_;
  std::vector<std::uint32_t> added_;
  ConstrainedTriangulation triangulation_;
};

}  // namespace viewgain::detail
