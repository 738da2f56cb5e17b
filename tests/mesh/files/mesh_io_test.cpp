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
#include "mesh/files/mesh_measures.hpp"

namespace viewgain {
namespace {

using test::cross;
using test::dot;
using test::expect_error;
using test::Measures;
using test::measures_of;
using test::minus;
using test::Point;

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
  EXPECT_EQ(rows, 204U);
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
  expect_error(ErrorCode::invalid_argument, "the mesh cannot be scaled", [] {
    (void)placed({{{1, 1, 1}, {1, 1, 1}}, {{0, 0, 1}}}, {.longest_side = 1});
  });
}

}  // namespace
}  // namespace viewgain
