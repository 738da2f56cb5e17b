// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Mesh files: the table of dialects, polygons that are split, headers that promise too much,
// placement.

#include "viewgain/mesh/mesh_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "mesh/files/mesh_dialects.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using Point = std::array<double, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Measures {
  double area = 0, volume = 0;
};

Measures measures_of(const TriangleMesh& mesh) {
  Measures m;
  for (const auto& t : mesh.triangles) {
    const Point &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Point normal = cross(minus(b, a), minus(c, a));
    m.area += std::sqrt(dot(normal, normal)) / 2;
    m.volume += dot(a, cross(b, c)) / 6;
  }
  return m;
}

class MeshIo : public testing::Test {
 protected:
  void expect_refused(const std::string& name, const std::string& bytes) const {
    const auto path = folder_.file(name, bytes);
    expect_error(ErrorCode::format, path.string(), [&] { (void)read_mesh(path); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(MeshIo, EveryDialectIsReadOrRefused) {
  std::size_t rows = 0;
  for (const test::MeshDialect& row : test::mesh_dialects()) {
    SCOPED_TRACE(row.file);
    const auto path = folder_.file(row.file, row.bytes);
    ++rows;
    try {
      const TriangleMesh mesh = read_mesh(path);
      EXPECT_EQ(row.refusal, "") << "was read";
      EXPECT_EQ(mesh.vertices.size(), row.vertices);
      EXPECT_EQ(mesh.triangles.size(), row.triangles);
      const Measures m = measures_of(mesh);
      EXPECT_NEAR(m.area, row.area, 1e-9 * row.area);
      // One face is turned over.
      EXPECT_NEAR(m.volume, row.file == "mixed.off" ? 10 + 20 : row.volume, 1e-9);
    } catch (const Error& error) {
      const std::string said = error.what();
      EXPECT_EQ(error.code(), ErrorCode::format) << said;
      EXPECT_NE(row.refusal, "") << said;
      EXPECT_NE(said.find(row.refusal), said.npos) << said;
      EXPECT_TRUE(said.starts_with(path.string() + ":")) << said;
      EXPECT_EQ(said.find('\n'), said.npos) << said;
    }
  }
  EXPECT_EQ(rows, 203U);
}

// Polygons with a random radius for each direction, in a random plane, against points in them.
TEST_F(MeshIo, PolygonsAreFilledOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t points = 0, inside = 0;
  for (std::size_t corners = 4; corners < 64; ++corners) {
    const double turn = 6.3 * unit(random), lift = 2 * unit(random) - 1;
    const Point u{std::cos(turn), std::sin(turn), lift}, v{-std::sin(turn), std::cos(turn), -lift};
    const auto place = [&](double x, double y) {
      return Point{7 + x * u[0] + y * v[0], x * u[1] + y * v[1], x * u[2] + y * v[2]};
    };
    std::vector<std::array<double, 2>> rim;
    std::string text = "OFF " + std::to_string(corners) + " 1\n", face = std::to_string(corners);
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle =
          2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
      const double radius = 0.1 + unit(random);
      rim.push_back({radius * std::cos(angle), radius * std::sin(angle)});
      for (const double x : place(rim.back()[0], rim.back()[1])) text += std::to_string(x) + ' ';
      text += '\n';
      face += ' ' + std::to_string(i);
    }
    const TriangleMesh mesh = read_mesh(folder_.file("polygon.off", text + face));
    ASSERT_EQ(mesh.triangles.size(), corners - 2);
    const Point up = cross(u, v);
    for (int i = 0; i < 200; ++i) {
      const double x = 2 * unit(random) - 1, y = 2 * unit(random) - 1;
      bool is_inside = false;
      for (std::size_t a = 0; a < corners; ++a) {
        const auto &p = rim[a], &q = rim[(a + 1) % corners];
        if ((p[1] > y) == (q[1] > y)) continue;
        if (x < p[0] + (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1])) is_inside = !is_inside;
      }
      int covered = 0;
      for (const auto& t : mesh.triangles) {
        bool left_of_all = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const Point &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
          left_of_all = left_of_all && dot(up, cross(minus(b, a), minus(place(x, y), a))) > 0;
        }
        covered += left_of_all ? 1 : 0;
      }
      points += covered == (is_inside ? 1 : 0) ? 1 : 0;
      inside += is_inside ? 1 : 0;
    }
  }
  // Some lie within rounding of an edge.
  EXPECT_GE(points, 60U * 200 - 3);
  EXPECT_GT(inside, 2000U);
}

TEST_F(MeshIo, LargePolygons) {
  // A comb: a fan would fill the gaps between its teeth.
  double twice_area = 0;
  const auto comb = [&](int teeth) {
    const int corners = 2 * teeth + 1;
    const auto at = [teeth](int i) {
      return i == 2 * teeth ? std::pair(teeth, -3 * teeth) : std::pair(i, i % 2);
    };
    std::string text = "OFF " + std::to_string(corners) + " 1\n", face = std::to_string(corners);
    for (int i = 0; i < corners; ++i) {
      const auto [x, y] = at(i);
      const auto [next_x, next_y] = at((i + 1) % corners);
      text += std::to_string(x) + ' ' + std::to_string(y) + " 0\n";
      face += ' ' + std::to_string(i);
      twice_area += static_cast<double>(x) * next_y - static_cast<double>(y) * next_x;
    }
    return folder_.file("comb.off", text + face);
  };
  const TriangleMesh mesh = read_mesh(comb(2000));
  EXPECT_EQ(mesh.triangles.size(), 3999U);
  EXPECT_NEAR(measures_of(mesh).area, std::abs(twice_area) / 2, 1e-9 * std::abs(twice_area));
  expect_error(ErrorCode::format, ":10003: face 0 has reflex corners among more than 10000",
               [&] { (void)read_mesh(comb(5000)); });
}

TEST_F(MeshIo, FilesThatAreNotThere) {
  expect_error(ErrorCode::io, "none.off", [&] { (void)read_mesh(folder_.path() / "none.off"); });
  EXPECT_THROW((void)read_mesh(folder_.path()), Error);
}

TEST_F(MeshIo, HeadersThatPromiseTooMuch) {
  for (const std::string count :
       {"4000000000", "4294967295", "2147483647", "99999999999999999999"}) {
    expect_refused("v.off", "OFF\n" + count + " 1 0\n0 0 0\n3 0 0 0\n");
    expect_refused("f.off", "OFF\n3 " + count + " 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_refused("c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + count + " 0 1 2\n");
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      const std::string head = "ply\nformat " + format + " 1.0\nelement vertex ";
      expect_refused("v.ply", head + count + "\n" + xyz + "end_header\n0 0 0\n");
      expect_refused("e.ply", head + count + "\nend_header\n0 0 0\n");
      expect_refused("f.ply", head + "1\n" + xyz + "element face " + count +
                                  "\nproperty list uchar int vertex_indices\nend_header\n" +
                                  "0 0 0 0 0 0 0 0 0 0 0 0 0\n");
    }
  }
  expect_refused("b.off", "OFF BINARY\n" + std::string(12, '\x7f') + std::string(60, '\0'));
}

TEST_F(MeshIo, Placement) {
  const auto path =
      folder_.file("box.off",
                   "OFF\n8 6 0\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n0 0 5\n2 0 5\n2 3 5\n0 3 5\n4 0 3 2 "
                   "1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const TriangleMesh box = read_mesh(path);
  const TriangleMesh scaled = read_mesh(path, {.longest_side = 0.5});
  EXPECT_NEAR(measures_of(scaled).volume, 30.0 * 1e-3, 1e-12);
  EXPECT_NEAR(scaled.vertices[6][2], 0.5, 1e-15);

  const TriangleMesh centred = placed(box, {.center = true});
  EXPECT_EQ(centred.vertices[0], (Point{-1, -1.5, -2.5}));
  EXPECT_EQ(centred.vertices[6], (Point{1, 1.5, 2.5}));
  EXPECT_EQ(read_mesh(path, {.center = true}).vertices, centred.vertices);

  // The corner (2, 3, 5): the axis that is up ends in z, and the volume keeps its sign.
  const TriangleMesh y_up = placed(box, {.up = UpAxis::y});
  EXPECT_EQ(y_up.vertices[6], (Point{5, 2, 3}));
  EXPECT_DOUBLE_EQ(measures_of(y_up).volume, 30.0);
  const TriangleMesh x_up = placed(box, {.up = UpAxis::x});
  EXPECT_EQ(x_up.vertices[6], (Point{3, 5, 2}));
  EXPECT_DOUBLE_EQ(measures_of(x_up).volume, 30.0);

  const TriangleMesh same = placed(box, {});
  EXPECT_EQ(same.vertices, box.vertices);
  EXPECT_EQ(same.triangles, box.triangles);

  EXPECT_THROW((void)placed(box, {.longest_side = std::nan("")}), Error);
  expect_error(ErrorCode::invalid_argument, path.string() + ": the longest side must be",
               [&] { (void)read_mesh(path, {.longest_side = -1e-9}); });
  const auto point = folder_.file("point.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
  expect_error(ErrorCode::invalid_argument, point.string() + ": the mesh has no extent to scale",
               [&] { (void)read_mesh(point, {.longest_side = 1}); });
}

}  // namespace
}  // namespace viewgain
