// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Polygons that cross themselves, are slivers or have no area, in every format; what is counted.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "mesh/files/mesh_measures.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain {
namespace {

using test::cross;
using test::dot;
using test::expect_error;
using test::measures_of;
using test::minus;
using test::normal_of;
using test::Point;
using Flat = std::array<double, 2>;

double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// How often a closed chain goes round a point that is not on it.
int winding_of(const std::vector<Flat>& chain, const Flat& p) {
  int winding = 0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Flat &a = chain[i], &b = chain[(i + 1) % chain.size()];
    if (a[1] <= p[1] && b[1] > p[1] && turn(a, b, p) > 0) ++winding;
    if (a[1] > p[1] && b[1] <= p[1] && turn(a, b, p) < 0) --winding;
  }
  return winding;
}

// Numbers in [0, 1) that are the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * kMixStep) {}
  double unit() { return static_cast<double>(mix64(state_ += kMixStep) >> 11U) * 0x1.0p-53; }
  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(unit() * static_cast<double>(n));
  }

 private:
  std::uint64_t state_;
};

std::string text_of(double x) {
  std::ostringstream out;
  out.precision(17);
  out << x;
  return out.str();
}

// One face of all points, in each format.
std::string off_of(const std::vector<Point>& points) {
  std::string text = "OFF " + std::to_string(points.size()) + " 1\n";
  std::string face = std::to_string(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double x : points[i]) text += text_of(x) + ' ';
    text += '\n';
    face += ' ' + std::to_string(i);
  }
  return text + face + '\n';
}
std::string obj_of(const std::vector<Point>& points) {
  std::string text, face = "f";
  for (std::size_t i = 0; i < points.size(); ++i) {
    text += "v";
    for (const double x : points[i]) text += ' ' + text_of(x);
    text += '\n';
    face += ' ' + std::to_string(i + 1);
  }
  return text + face + '\n';
}
std::string ply_of(const std::vector<Point>& points) {
  const std::string count = std::to_string(points.size());
  const std::string off = off_of(points);
  return "ply\nformat ascii 1.0\nelement vertex " + count +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n"
         "property list int int vertex_indices\nend_header\n" +
         off.substr(off.find('\n') + 1);
}
std::string stl_of(const std::vector<Point>& points) {
  std::string text = "solid\nfacet normal 0 0 0\nouter loop\n";
  for (const Point& p : points) {
    text += "vertex";
    for (const double x : p) text += ' ' + text_of(x);
    text += '\n';
  }
  return text + "endloop\nendfacet\nendsolid\n";
}

struct Read {
  TriangleMesh mesh;
  MeshRepairs repairs;
};

class Polygons : public testing::Test {
 protected:
  [[nodiscard]] Read read(const std::string& name, const std::string& bytes) const {
    Read result;
    result.mesh = read_mesh(folder_.file(name, bytes), &result.repairs);
    return result;
  }
  [[nodiscard]] Read read(const std::vector<Point>& points) const {
    return read("polygon.off", off_of(points));
  }
  test::TemporaryFolder folder_;
};

struct Row {
  std::string name;
  std::vector<Point> points;
  double area;
  std::size_t triangles, mended;
};

// A regular star of `points` corners, each joined to the one `step` on.
std::vector<Point> star_of(int points, int step) {
  std::vector<Point> star;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * i * step / points;
    star.push_back({std::cos(angle), std::sin(angle), 0});
  }
  return star;
}

// Its area, its core included: two triangles from the centre per corner.
double area_of_star(int points, int step) {
  const double half = std::numbers::pi / points;
  const double inner = std::cos(step * half) / std::cos((step - 1) * half);
  return points * inner * std::sin(half);
}

std::vector<Row> rows() {
  const double far = 5e6;  // as in coordinates of a map
  return {
      {"bow tie", {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, 2, 2, 1},
      {"bow tie, uneven", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1.5, 0}}, 0.6, 2, 1},
      {"bow tie, upright", {{3, 0, 0}, {3, 2, 2}, {3, 2, 0}, {3, 0, 2}}, 2, 2, 1},
      {"bow tie, tilted", {{0, 0, 0}, {2, 2, 2}, {2, 0, 2}, {0, 2, 0}}, 2 * std::sqrt(2.0), 2, 1},
      {"bow tie, far off",
       {{far, far, far}, {far + 2, far + 2, far}, {far + 2, far, far}, {far, far + 2, far}},
       2,
       2,
       1},
      {"two rhombi", {{0, 0, 0}, {1, 2, 0}, {3, -2, 0}, {4, 0, 0}, {3, 2, 0}, {1, -2, 0}}, 8, 4, 1},
      // Its edges cross n (step - 1) times; 2 n of all corners and crossings are on the outline.
      {"star of 5", star_of(5, 2), area_of_star(5, 2), 8, 1},
      {"star of 7", star_of(7, 3), area_of_star(7, 3), 26, 1},
      {"star of 101", star_of(101, 50), area_of_star(101, 50), 9896, 1},
      {"square twice round",
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
       1,
       2,
       1},
      {"square there and back",
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}},
       0,
       0,
       0},
      {"corner twice", {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1, 2, 0},
      {"first corner at the end", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1, 2, 0},
      {"every corner twice",
       {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 0}},
       1,
       2,
       0},
      {"triangle of four", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}, 0.5, 1, 0},
      {"points on edges",
       {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
       4,
       6,
       0},
      {"spike", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 5, 0}, {2, 2, 0}, {0, 2, 0}}, 4, 2, 0},
      {"spike inward", {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 1, 0}, {2, 2, 0}, {0, 2, 0}}, 4, 4, 0},
      {"touches itself", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}, 8, 2, 0},
      {"two that touch",
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}},
       2,
       4,
       0},
      {"arrow", {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}}, 1, 2, 0},
      {"keyhole, points of its own",
       {{0, 0, 0},
        {4, 0, 0},
        {4, 4, 0},
        {0, 4, 0},
        {0, 0, 0},
        {1, 1, 0},
        {1, 3, 0},
        {3, 3, 0},
        {3, 1, 0},
        {1, 1, 0}},
       12,
       8,
       0},
      {"keyhole, wound the other way",
       {{0, 0, 0},
        {0, 4, 0},
        {4, 4, 0},
        {4, 0, 0},
        {0, 0, 0},
        {1, 1, 0},
        {3, 1, 0},
        {3, 3, 0},
        {1, 3, 0},
        {1, 1, 0}},
       12,
       8,
       0},
      {"two keyholes",
       {{0, 0, 0},
        {9, 0, 0},
        {9, 4, 0},
        {0, 4, 0},
        {0, 0, 0},
        {1, 1, 0},
        {1, 3, 0},
        {3, 3, 0},
        {3, 1, 0},
        {1, 1, 0},
        {3, 1, 0},
        {5, 1, 0},
        {5, 3, 0},
        {7, 3, 0},
        {7, 1, 0},
        {5, 1, 0},
        {3, 1, 0},
        {1, 1, 0}},
       28,
       14,
       0},
      {"one corner lifted",
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 1e-4}, {0, 1, 0}},
       0.5 * std::sqrt(1 + 1e-8) * 2,
       2,
       0},
      {"in a line", {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {2, 0, 0}}, 0, 0, 0},
      {"in a skew line", {{0, 0, 0}, {.1, .2, .3}, {.3, .6, .9}, {.2, .4, .6}}, 0, 0, 0},
      {"in a point", {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, 0, 0, 0},
  };
}

TEST_F(Polygons, AreasInEveryFormat) {
  for (const Row& row : rows()) {
    for (const auto& [name, bytes] :
         {std::pair<std::string, std::string>{"p.off", off_of(row.points)},
          {"p.obj", obj_of(row.points)},
          {"p.ply", ply_of(row.points)},
          {"p.stl", stl_of(row.points)}}) {
      SCOPED_TRACE(row.name + ", " + name);
      if (row.area == 0) {
        expect_error(ErrorCode::format, name + ": all faces of the mesh have the area 0",
                     [&, &n = name, &b = bytes] { (void)read(n, b); });
        continue;
      }
      const Read r = read(name, bytes);
      EXPECT_NEAR(measures_of(r.mesh).area, row.area, 1e-9 * row.area);
      EXPECT_EQ(r.mesh.triangles.size(), row.triangles);
      EXPECT_EQ(r.repairs.mended_faces, row.mended);
      EXPECT_EQ(r.repairs.dropped_faces, 0U);
    }
  }
}

TEST_F(Polygons, CrossingsLieMidwayBetweenTheirEdges) {
  const Read r = read({{0, 0, 0}, {2, 2, 0.2}, {2, 0, 0}, {0, 2, 0}});
  ASSERT_EQ(r.mesh.vertices.size(), 5U);
  const Point expected{1, 1, 0.05};
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(r.mesh.vertices[4][k], expected[k], 1e-15);
  // Each half turns as the polygon does round it.
  double up = 0;
  for (const auto& t : r.mesh.triangles) up += normal_of(r.mesh, t)[2];
  EXPECT_NEAR(up, 0, 1e-15);
}

TEST_F(Polygons, Slivers) {
  for (double width = 1e-2; width > 1e-11; width *= 0.1) {
    SCOPED_TRACE(width);
    const Read convex = read({{0, 0, 0}, {1, 0, 0}, {1, width, 0}, {0, width, 0}});
    EXPECT_NEAR(measures_of(convex.mesh).area, width, 2e-4 * width);
    EXPECT_EQ(convex.repairs.mended_faces, 0U);
    const Read tie = read({{0, 0, 0}, {1, width, 0}, {1, 0, 0}, {0, width, 0}});
    EXPECT_NEAR(measures_of(tie.mesh).area, 0.5 * width, 2e-4 * width);
    EXPECT_EQ(tie.repairs.mended_faces, 1U);
    const Read reflex = read({{0, 0, 0}, {0.5, 0.25 * width, 0}, {1, 0, 0}, {0.5, width, 0}});
    EXPECT_NEAR(measures_of(reflex.mesh).area, 0.375 * width, 2e-4 * width);
    EXPECT_EQ(reflex.repairs.mended_faces, 0U);
  }
  // Narrower than rounding makes a line.
  const std::string good = "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n";
  const Read line =
      read("line.obj", good + "v 0 0 0\nv 1 0 0\nv 1 1e-14 0\nv 0 1e-14 0\nf 4 5 6 7\n");
  EXPECT_EQ(line.mesh.triangles.size(), 1U);
  EXPECT_EQ(line.repairs.dropped_faces, 1U);
}

// Corners of a lattice meet, repeat and lie on one another's edges, but for rounding in a tilted
// plane; others cross at will.
TEST_F(Polygons, FillAllThatTheyGoRoundOnce) {
  Random random(5);
  std::size_t points = 0, inside = 0, wrong = 0;
  for (std::size_t round = 0; round < 250; ++round) {
    const std::size_t corners = 4 + random.below(20), lattice = round % 2 == 0 ? 3 + round % 5 : 0;
    const double azimuth = 6.3 * random.unit(), lift = 2 * random.unit() - 1;
    const Point u{std::cos(azimuth), std::sin(azimuth), lift};
    const Point v{-std::sin(azimuth), std::cos(azimuth), -lift};
    const auto place = [&](const Flat& p) {
      return Point{7 + p[0] * u[0] + p[1] * v[0], p[0] * u[1] + p[1] * v[1],
                   p[0] * u[2] + p[1] * v[2]};
    };
    const auto coordinate = [&] {
      if (lattice == 0) return random.unit();
      return static_cast<double>(random.below(lattice)) / static_cast<double>(lattice - 1);
    };
    std::vector<Flat> chain;
    std::vector<Point> corners_of;
    for (std::size_t i = 0; i < corners; ++i) {
      const double x = coordinate();
      chain.push_back({x, coordinate()});
      corners_of.push_back(place(chain.back()));
    }
    Read r;
    try {
      r = read(corners_of);
    } catch (const Error& error) {  // which the points confirm
      EXPECT_NE(std::string(error.what()).find("have the area 0"), std::string::npos)
          << error.what();
    }
    const Point up = cross(u, v);
    for (int i = 0; i < 50; ++i) {
      const Flat at{random.unit(), random.unit()};
      const Point p = place(at);
      int covered = 0, turns = 0;
      for (const auto& t : r.mesh.triangles) {
        const double side = dot(up, normal_of(r.mesh, t)) > 0 ? 1 : -1;
        bool holds = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const Point &a = r.mesh.vertices[t[k]], &b = r.mesh.vertices[t[(k + 1) % 3]];
          holds = holds && side * dot(up, cross(minus(b, a), minus(p, a))) > 0;
        }
        covered += holds ? 1 : 0;
        turns += holds ? static_cast<int>(side) : 0;
      }
      // The triangles that cover it turn as the chain goes round it, or all the other way.
      const int winding = winding_of(chain, at);
      const bool is_right = covered == (winding != 0 ? 1 : 0) && (turns > 0) == (winding > 0);
      wrong += is_right ? 0 : 1;
      inside += winding != 0 ? 1 : 0;
      ++points;
    }
  }
  EXPECT_LE(wrong, 3U);  // within rounding of an edge
  EXPECT_GT(inside, points / 4);
}

TEST_F(Polygons, WhatIsCounted) {
  const std::string vertices =
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 0 0\nv 0 0 0\nv 4 0 0\nv 9 9 9\n";
  // Two bow ties; a triangle in a line, in two points, of one corner; a quad in a line. Edges and
  // points are no faces.
  const Read r = read("a.obj", vertices +
                                   "f 1 2 3 4\nf 1 3 2 4\nf 4 2 3 1\nf 1 5 2\nf 1 2 6\nf 3 3 3\n"
                                   "f 1 5 2 7\nf 1 2\nf 3\nl 1 2\n");
  EXPECT_EQ(r.repairs.mended_faces, 2U);
  EXPECT_EQ(r.repairs.dropped_faces, 4U);
  EXPECT_EQ(r.mesh.triangles.size(), 6U);
  EXPECT_EQ(r.mesh.vertices.size(), 6U);
  EXPECT_NEAR(measures_of(r.mesh).area, 8, 1e-12);
  // What was counted before does not stay.
  MeshRepairs repairs{5, 5};
  (void)read_mesh(folder_.file("b.obj", vertices + "f 1 2 3 4\n"), {.longest_side = 1}, &repairs);
  EXPECT_EQ(repairs.mended_faces, 0U);
  EXPECT_EQ(repairs.dropped_faces, 0U);
}

// A comb: a fan would fill the gaps between its teeth, and its base is seen by every one of them.
TEST_F(Polygons, LargeOnes) {
  constexpr int kTeeth = 20'000;
  std::vector<Point> comb{{0, -1, 0}, {2 * kTeeth, -1, 0}};
  for (int i = 2 * kTeeth; i >= 0; --i) comb.push_back({static_cast<double>(i), i % 2 * 5.0, 0});
  const Read r = read(comb);
  EXPECT_EQ(r.mesh.triangles.size(), comb.size() - 2);
  EXPECT_NEAR(measures_of(r.mesh).area, 2.0 * kTeeth * (1 + 2.5), 1e-6);
  EXPECT_EQ(r.repairs.mended_faces, 0U);
}

// Every edge crosses a third of the others; memory and time stay bounded.
TEST_F(Polygons, HostileOnesAreRefused) {
  Random random(2);
  std::vector<Point> points;
  for (int i = 0; i < 3000; ++i) points.push_back({random.unit(), random.unit(), 0});
  expect_error(ErrorCode::format, "polygon.off:3002: face 0 crosses itself too often",
               [&] { (void)read(points); });
  // As many faces as the file likes do not multiply it.
  points.resize(400);
  std::string text = off_of(points);
  const std::string face = text.substr(text.rfind('\n', text.size() - 2) + 1);
  text.replace(text.find(" 1\n"), 3, " 200\n");
  for (int i = 1; i < 200; ++i) text += face;
  expect_error(ErrorCode::format, "crosses itself too often",
               [&] { (void)read("many.off", text); });
}

}  // namespace
}  // namespace viewgain
