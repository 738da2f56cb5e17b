// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/front_growth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace viewgain {
namespace {

using namespace detail::front;

using Points = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<std::size_t, 3>>;

// Triangles of the front, by CGAL's own loop or by ours.
Triangles grown(const Points& points, double max_edge, bool by_cgal) {
  std::vector<std::pair<Kernel::Point_3, std::size_t>> input;
  for (const auto& p : points) input.emplace_back(Kernel::Point_3(p[0], p[1], p[2]), input.size());
  Triangulation triangulation(input.begin(), input.end());
  const std::vector<double> max_edges(points.size(), max_edge);
  const BoundedEdges priority{max_edges};
  Front front(triangulation, priority);
  const Delaunay& delaunay = triangulation;
  triangulation.set_seeds({delaunay.finite_facets_begin(), delaunay.finite_facets_end()});
  if (by_cgal) {
    front.run();
  } else {
    FrontGrowth(front, priority).run();
  }
  Triangles triangles;
  for (const auto cell : triangulation.all_cell_handles()) {
    for (int i = 0; i < 4; ++i) {
      if (!cell->is_selected_facet(i)) continue;
      const auto corner = [&](int k) { return cell->vertex((i + k) & 3)->id(); };
      triangles.push_back({corner(1), corner(2), corner(3)});
    }
  }
  return triangles;
}

// Sheets with noise, holes and steps, some of them near each other, and loose points: borders of
// which many edges wait.
Points sheets(unsigned seed, double noise, double loose) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, noise);
  Points points;
  for (int sheet = 0; sheet < 4; ++sheet) {
    const double above = 3.0 * sheet + unit(random), bend = 0.05 * unit(random);
    const double hole_x = 24 * unit(random), hole_y = 24 * unit(random), hole = 6 * unit(random);
    for (int x = 0; x < 24; ++x) {
      for (int y = 0; y < 24; ++y) {
        if (std::hypot(x - hole_x, y - hole_y) < hole || unit(random) < 0.1) continue;
        points.push_back({x + 0.3 * unit(random), y + 0.3 * unit(random),
                          above + bend * (x - 12) * (x - 12) + normal(random)});
      }
    }
  }
  const auto count = static_cast<std::size_t>(loose * static_cast<double>(points.size()));
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({24 * unit(random), 24 * unit(random), 16 * unit(random)});
  }
  return points;
}

TEST(FrontGrowth, HasTheTrianglesOfCgalsOwnLoop) {
  std::size_t cases = 0, triangles = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    for (const double noise : {0.05, 0.3, 0.8}) {
      for (const double loose : {0.0, 0.2}) {
        const Points points = sheets(seed, noise, loose);
        const double max_edge = seed % 3 == 0 ? 2.5 : 4;
        const Triangles ours = grown(points, max_edge, false);
        EXPECT_EQ(ours, grown(points, max_edge, true)) << seed << " " << noise << " " << loose;
        triangles += ours.size();
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, 72U);
  EXPECT_GT(triangles, 72U * 1000U);
}

// CGAL adds a vertex to flat points, and decides ties of regular ones by the order of the edges.
TEST(FrontGrowth, HasThemForFewFlatAndRegularPoints) {
  Points flat, cube;
  for (int x = 0; x < 9; ++x) {
    for (int y = 0; y < 9; ++y) flat.push_back({1.0 * x, 1.0 * y, 0});
  }
  for (int i = 0; i < 125; ++i) cube.push_back({1.0 * (i % 5), 1.0 * (i / 5 % 5), 1.0 * (i / 25)});
  const Points tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Points triangle(tetrahedron.begin(), tetrahedron.begin() + 3);
  std::size_t cases = 0;
  for (const Points& points : {triangle, tetrahedron, flat, cube}) {
    for (const double max_edge : {1.2, 1.5, 4.0}) {
      EXPECT_EQ(grown(points, max_edge, false), grown(points, max_edge, true))
          << points.size() << " points, edges up to " << max_edge;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 12U);
}

}  // namespace
}  // namespace viewgain
