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

/// Splits polygons in space into triangles that fill them: a fan of the first corner where that
/// does, else a constrained triangulation. A polygon is looked at along the axis nearest to its
/// normal, so it need not be quite plane. It fills all places that it goes round, that is with a
/// winding number other than 0; a hole joined to the rim stays open.
class PolygonFill {
 public:
  /// Adds the triangles of a polygon of three corners or more to the mesh, and a vertex where edges
  /// cross; triangles without area are left out, so there may be none. Triangles turn as the
  /// polygon does round them. True if the polygon crosses itself by more than rounding. Throws
  /// Error(format), whose subject is the face, if the budget is used up.
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

  std::vector<std::uint32_t> corners_;  // without those at the place of the one before
  std::vector<Point> points_;           // from the first one
  Point first_{};
  std::vector<Flat> flat_;
  double extent_ = 0;   // the largest coordinate
  double no_area_ = 0;  // what rounding makes of none, twice an area
  std::vector<GridPoint> grid_;
  std::vector<std::uint32_t> added_;
  ConstrainedTriangulation triangulation_;
};

}  // namespace viewgain::detail
