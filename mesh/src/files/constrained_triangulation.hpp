// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "grid_predicates.hpp"

namespace viewgain::detail {

/// Remaining cost allowed for a file's polygons, so that a malicious file causes an error.
struct FillBudget {
  std::size_t steps = 0;      ///< triangles visited or flipped
  std::size_t crossings = 0;  ///< vertices added where edges cross
};

/// Constrained triangulation of one closed chain of edges in the plane, which may cross, touch and
/// repeat itself. All decisions are exact, because points lie on an integer grid. Rounding a
/// crossing to the grid bends an edge but does not break the chain, so every triangle has a winding
/// number.
class ConstrainedTriangulation {
 public:
  using Index = std::uint32_t;
  using Point = std::array<double, 3>;
  struct Triangle {
    std::array<Index, 3> nodes;  ///< turning to the left
    std::int64_t winding;        ///< of the chain around the triangle, not 0
    double twice_area;           ///< [grid units²]
  };
  /// Coordinates lie in [0, kGrid].
  static constexpr std::int64_t kGrid = std::int64_t{1} << 50;

  /// `flat` are the chain's corners in the plane, `corners` the same corners in space. False if the
  /// budget is used up. Expected cost: O(n log n) and the number of crossed triangles.
  [[nodiscard]] bool build(const std::vector<GridPoint>& flat, const std::vector<Point>& corners,
                           FillBudget& budget);

  /// The triangles inside the chain (winding number not 0), in a fixed order.
  [[nodiscard]] std::vector<Triangle> inside() const;
  /// The first corner at a node's position; kNone for a crossing.
  [[nodiscard]] Index corner_of(Index node) const { return nodes_[node].corner; }
  /// A node's position in space; for a crossing, midway between its two edges.
  [[nodiscard]] const Point& position_of(Index node) const { return nodes_[node].position; }

  static constexpr Index kNone = 0xffffffffU;

 private:
  struct Node {
    GridPoint at;
    Index corner = kNone;
    Point position{};
  };
  struct Constraint {
    Index from, to;
    std::int32_t count;  // passes from `from` to `to`, minus those in the other direction
  };
  // An edge at the rim of the hole for a new edge: an edge of the triangulation or, if `is_new`, of
  // a triangle in the hole.
  struct Rim {
    Index node;  // end of the edge
    Index edge = kNone, twin = kNone;
    std::int32_t flow = 0;
    bool is_new = false;
  };

  static Index next(Index edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
  static Index before(Index edge) { return edge % 3 == 0 ? edge + 2 : edge - 1; }
  [[nodiscard]] Index apex(Index edge) const { return origin_[before(edge)]; }
  [[nodiscard]] int side(Index a, Index b, const GridPoint& p) const;
  [[nodiscard]] bool is_delaunay(Index edge) const;

  void start();
  Index add_node(const GridPoint& at, Index corner, const Point& position);
  Index add_triangle(Index a, Index b, Index c);
  void set_triangle(Index edge, Index a, Index b, Index c);
  void link(Index a, Index b);
  void add_flow(Index edge, std::int32_t count);
  void flip(Index edge);
  void make_delaunay();
  [[nodiscard]] bool spend(std::size_t steps);

  [[nodiscard]] Index triangle_at(const GridPoint& p, Index edge);
  Index insert(const GridPoint& p, Index corner, const Point& position, Index edge);
  [[nodiscard]] bool insert_corners(const std::vector<GridPoint>& flat,
                                    const std::vector<Point>& corners);
  void collect_constraints();
  [[nodiscard]] bool lay(const Constraint& constraint);
  [[nodiscard]] Index leave(const Constraint& constraint, bool& is_done);
  [[nodiscard]] bool cross(const Constraint& constraint, Index edge);
  [[nodiscard]] bool fill_hole(const Constraint& constraint);
  Index fill_side(std::vector<Rim>& rim);
  void attach(const Rim& rim, Index edge);

  std::vector<Node> nodes_;     // the first four are a square around all
  std::vector<Index> edge_of_;  // an edge that begins at the node
  // Half-edges, three per triangle, counter-clockwise.
  std::vector<Index> origin_, twin_;
  // Passes of the chain along it, minus those in the other direction.
  std::vector<std::int32_t> flow_;
  std::vector<Index> moved_;    // new place of a rim's edge, while a hole is filled
  std::vector<Index> node_of_;  // by corner
  std::vector<Constraint> constraints_;
  std::vector<Index> stack_, hole_;
  std::vector<Rim> left_, right_, rims_, chain_;
  FillBudget* budget_ = nullptr;
};

}  // namespace viewgain::detail
