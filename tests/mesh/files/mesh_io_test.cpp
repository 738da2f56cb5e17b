// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/mesh/mesh_io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

class MeshIo : public testing::Test {
 protected:
  // Reading throws an Error of one line that has the part and the file's name.
  void expect_refused(const std::string& name, const std::string& bytes,
                      const std::string& part = "") const {
    const auto path = write(name, bytes);
    try {
      (void)read_mesh(path);
      ADD_FAILURE() << name << " was read: " << bytes.substr(0, 60);
    } catch (const Error& error) {
      const std::string said = error.what();
      EXPECT_EQ(error.code(), ErrorCode::format) << said;
      for (const std::string& word : {name, part}) EXPECT_NE(said.find(word), said.npos) << said;
      EXPECT_EQ(said.find('\n'), said.npos) << said;
    }
  }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    return folder_.file(name, bytes);
  }

  test::TemporaryFolder folder_;
};

template <typename Number>
void append(std::string& bytes, Number value, bool big_endian = false) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &value, sizeof value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto& a = mesh.vertices[t[0]];
    const auto& b = mesh.vertices[t[1]];
    const auto& c = mesh.vertices[t[2]];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
}

// A box of 2 x 3 x 5 with quadrilateral faces, volume 30.
constexpr const char* kBoxVertices = "0 0 0\n2 0 0\n2 3 0\n0 3 0\n0 0 5\n2 0 5\n2 3 5\n0 3 5\n";
constexpr const char* kBoxFaces =
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
const std::string kBoxOff = std::string("OFF\n8 6 0\n") + kBoxVertices + kBoxFaces;

constexpr const char* kPlyHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const std::vector<std::array<float, 3>> kTetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::array<int, 3>> kTetrahedronFaces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

std::string binary_ply(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\ncomment a tetrahedron\n" + kPlyHeader;
  for (const auto& v : kTetrahedron) {
    for (const float x : v) append(bytes, x, big_endian);
  }
  for (const auto& f : kTetrahedronFaces) {
    append(bytes, std::uint8_t{3});
    for (const int i : f) append(bytes, i, big_endian);
  }
  return bytes;
}

std::string binary_stl(const char* header) {
  std::string bytes(header);
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(kTetrahedronFaces.size()));
  for (const auto& f : kTetrahedronFaces) {
    for (int k = 0; k < 3; ++k) append(bytes, 0.0F);
    for (const int i : f) {
      for (const float x : kTetrahedron[static_cast<std::size_t>(i)]) append(bytes, x);
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string ascii_stl() {
  std::string text = "solid tetrahedron\n";
  for (const auto& f : kTetrahedronFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : f) {
      text += "vertex";
      for (const float x : kTetrahedron[static_cast<std::size_t>(i)])
        text += ' ' + std::to_string(x);
      text += '\n';
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

TEST_F(MeshIo, ReadsOffAndSplitsPolygons) {
  const TriangleMesh mesh = read_mesh(write("box.off", kBoxOff));
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(volume(mesh), 30.0);
}

TEST_F(MeshIo, ReadsCommentsColoursAndCapitalEndings) {
  std::string text = "# a box\nCOFF # flags\n8 6 0\n";
  std::istringstream vertices(kBoxVertices);
  int i = 0;
  // Only some vertices carry a colour, which CGAL's own reader does not survive.
  for (std::string line; std::getline(vertices, line); ++i) {
    text += line + (i % 2 == 0 ? " 255 0 0 255\n" : "\n");
  }
  const TriangleMesh mesh = read_mesh(write("BOX.OFF", text + kBoxFaces));
  EXPECT_DOUBLE_EQ(volume(mesh), 30.0);
}

TEST_F(MeshIo, ReadsBinaryOff) {
  std::string bytes = "OFF BINARY\n";
  for (const int n : {4, 4, 0}) append(bytes, n, true);
  for (const auto& v : kTetrahedron) {
    for (const float x : v) append(bytes, x, true);
  }
  for (const auto& f : kTetrahedronFaces) {
    append(bytes, 3, true);
    for (const int i : f) append(bytes, i, true);
  }
  EXPECT_NEAR(volume(read_mesh(write("t.off", bytes))), 1.0 / 6, 1e-12);
}

TEST_F(MeshIo, ReadsObjWithTextureIndicesAndNegativeIndices) {
  std::string text = "# box\n";
  std::istringstream vertices(kBoxVertices);
  for (std::string line; std::getline(vertices, line);) text += "v " + line + "\n";
  text += "vt 0 0\nf 1/1 4/1 3/1 2/1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf -6 -5 -1 -2\nf 4 1 5 8\n";
  EXPECT_DOUBLE_EQ(volume(read_mesh(write("box.obj", text))), 30.0);
}

TEST_F(MeshIo, ReadsPlyAndStlAsciiAndBinary) {
  std::string ascii = std::string("ply\nformat ascii 1.0\n") + kPlyHeader;
  for (const auto& v : kTetrahedron) {
    for (const float x : v) ascii += std::to_string(x) + ' ';
    ascii += '\n';
  }
  for (const auto& f : kTetrahedronFaces) {
    ascii += "3";
    for (const int i : f) ascii += ' ' + std::to_string(i);
    ascii += '\n';
  }
  const std::vector<std::pair<std::string, std::string>> files{{"a.ply", ascii},
                                                               {"l.ply", binary_ply(false)},
                                                               {"b.ply", binary_ply(true)},
                                                               {"a.stl", ascii_stl()},
                                                               {"b.stl", binary_stl("an exporter")},
                                                               {"s.stl", binary_stl("solid x")}};
  for (const auto& [name, bytes] : files) {
    const TriangleMesh mesh = read_mesh(write(name, bytes));
    EXPECT_NEAR(volume(mesh), 1.0 / 6, 1e-12) << name;
    EXPECT_EQ(mesh.triangles.size(), 4U) << name;
  }
}

TEST_F(MeshIo, MissingAndForeignFiles) {
  test::expect_error(ErrorCode::io, "none.off",
                     [&] { (void)read_mesh(folder_.path() / "none.off"); });
  expect_refused("mesh.txt", "OFF", "not a mesh file");
  expect_refused("empty.off", "", "empty");
  expect_refused("png.off", "\x89PNG\r\n\x1a\n");
  expect_refused("png.ply", "\x89PNG\r\n\x1a\n");
  expect_refused("png.stl", "\x89PNG\r\n\x1a\n");
  expect_refused("png.obj", "\x89PNG\r\n\x1a\n");
  EXPECT_THROW((void)read_mesh(folder_.path()), Error);
}

TEST_F(MeshIo, NoFaces) {
  expect_refused("a.off", std::string("OFF\n8 0 0\n") + kBoxVertices, "no faces");
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces");
  expect_refused("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty "
                 "float y\nproperty float z\nend_header\n0 0 0\n",
                 "no faces");
  expect_refused("a.stl", std::string(84, '\0'), "no faces");
  expect_refused("edges.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n2 0 1\n", "no faces");
}

TEST_F(MeshIo, CoordinatesThatAreNotFinite) {
  const std::string triangle = "3 0 1 2\n";
  for (const std::string bad : {"nan", "inf", "-inf", "NaN"}) {
    expect_refused("a.off", "OFF\n3 1 0\n0 0 0\n1 " + bad + " 0\n0 1 0\n" + triangle, "not finite");
    expect_refused("a.obj", "v 0 0 0\nv 1 " + bad + " 0\nv 0 1 0\nf 1 2 3\n", "not finite");
  }
  std::string ply = binary_ply(false);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(ply.data() + ply.find("end_header\n") + 11 + 12, &nan, sizeof nan);
  expect_refused("n.ply", ply, "not finite");
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
    expect_refused("l.ply",
                   "ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
                       "element face 1\nproperty list uint int vertex_indices\nend_header\n"
                       "0 0 0\n" +
                       count + " 0 0 0\n");
  }
  std::string stl = binary_stl("x");
  stl.replace(80, 4, "\xff\xff\xff\xff");
  expect_refused("p.stl", stl, "promises 4294967295");
}

TEST_F(MeshIo, IndicesOutOfRange) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  for (const std::string index : {"3", "-1", "4294967296"}) {
    expect_refused("a.off", "OFF\n3 1 0\n" + points + "3 0 1 " + index + "\n", "out of range");
  }
  for (const std::string index : {"4", "0", "-4"}) {
    expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 " + index + "\n", "out of range");
  }
  std::string ply = binary_ply(false);
  const int index = 4;
  std::memcpy(ply.data() + ply.size() - 4, &index, sizeof index);
  expect_refused("a.ply", ply, "out of range");
}

TEST_F(MeshIo, ForgedPlyHeaders) {
  const std::string head = "ply\nformat ascii 1.0\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  expect_refused("a.ply", head + "property float x\nend_header\n");
  expect_refused("c.ply", head + "element vertex 1\nproperty float x\nproperty float y\n" + face +
                              "0 0\n3 0 0 0\n");
  expect_refused("d.ply", head + "element vertex 1\nproperty quad x\n" + face + "0 0\n3 0 0 0\n");
}

TEST_F(MeshIo, Placement) {
  const TriangleMesh box = read_mesh(write("box.off", kBoxOff));
  const TriangleMesh scaled = placed(box, {.longest_side = 0.5});
  EXPECT_NEAR(volume(scaled), 30.0 * 1e-3, 1e-12);
  EXPECT_NEAR(scaled.vertices[6][2], 0.5, 1e-15);

  const TriangleMesh centred = placed(box, {.center = true});
  EXPECT_EQ(centred.vertices[0], (std::array<double, 3>{-1, -1.5, -2.5}));
  EXPECT_EQ(centred.vertices[6], (std::array<double, 3>{1, 1.5, 2.5}));

  // The corner (2, 3, 5): the axis that is up ends in z, and the volume keeps its sign.
  const TriangleMesh y_up = placed(box, {.up = UpAxis::y});
  EXPECT_EQ(y_up.vertices[6], (std::array<double, 3>{5, 2, 3}));
  EXPECT_DOUBLE_EQ(volume(y_up), 30.0);
  const TriangleMesh x_up = placed(box, {.up = UpAxis::x});
  EXPECT_EQ(x_up.vertices[6], (std::array<double, 3>{3, 5, 2}));
  EXPECT_DOUBLE_EQ(volume(x_up), 30.0);

  const TriangleMesh same = placed(box, {});
  EXPECT_EQ(same.vertices, box.vertices);
  EXPECT_EQ(same.triangles, box.triangles);

  EXPECT_THROW((void)placed(box, {.longest_side = -1}), Error);
  EXPECT_THROW((void)placed(box, {.longest_side = std::nan("")}), Error);
  TriangleMesh point;
  point.vertices = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  point.triangles = {{0, 1, 2}};
  EXPECT_THROW((void)placed(point, {.longest_side = 1}), Error);
}

}  // namespace
}  // namespace viewgain
