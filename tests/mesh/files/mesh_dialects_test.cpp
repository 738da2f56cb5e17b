// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What mesh files of other programs hold besides vertices and faces, and that messages name the
// file.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/mesh/mesh_io.hpp"

namespace viewgain {
namespace {

using test::expect_error;

class MeshDialects : public testing::Test {
 protected:
  // A square of two triangles with corners (0, 0, 0) and (1, 1, 0).
  void expect_square(const std::string& name, const std::string& bytes) {
    const TriangleMesh mesh = read_mesh(folder_.file(name, bytes));
    EXPECT_EQ(mesh.vertices, kCorners) << name;
    EXPECT_EQ(mesh.triangles, kTriangles) << name;
  }
  void expect_refused(const std::string& name, const std::string& part, const std::string& bytes) {
    const auto path = folder_.file(name, bytes);
    expect_error(ErrorCode::format, part, [&] { (void)read_mesh(path); });
    expect_error(ErrorCode::format, path.string(), [&] { (void)read_mesh(path); });
  }

  const std::vector<std::array<double, 3>> kCorners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> kTriangles{{0, 1, 2}, {0, 2, 3}};
  test::TemporaryFolder folder_;
};

const std::string kObjVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string kOff = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n" +
    kFaces + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

TEST_F(MeshDialects, ObjWithLinesAndTabs) {
  expect_square("lines.obj", kObjVertices + "l 1 2\nf 1 2 3 4\n l 2 3 4\n");
  expect_square("tabs.obj", kObjVertices + "f\t1\t2\t3\t4\n");
  expect_square("slashes.obj", kObjVertices + "f 1/1/1\t2/2/1\t3//1\t4\n");
  expect_square("vertices.obj", "v\t0 0\t0\nv\t1\t0\t0\nv 1 1 0\r\nv 0 1 0\nf 1 2 3 4\r\n");
  expect_refused("zero.obj", "zero.obj:6: index 0", kObjVertices + "l 0 1\nf\t1\t0\t3\n");
  expect_refused("only.obj", "no faces", kObjVertices + "l 1 2 3 4\n");
}

TEST_F(MeshDialects, NormalsThatAreNoNumbers) {
  const std::string header =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\nproperty float ny\nproperty float nz\n" +
      kFaces;
  std::string ascii = "ply\nformat ascii 1.0\n" + header;
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + header;
  std::string off = "NOFF\n4 1 0\n";
  for (const auto& [x, y, z] : kCorners) {
    const std::string xyz = std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z);
    ascii += xyz + " nan NaN -nan\n";
    off += xyz + " nan nan nan\n";
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const std::array row{
        static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), kNaN, kNaN, kNaN};
    binary.append(reinterpret_cast<const char*>(row.data()), sizeof row);
  }
  const std::array<std::int32_t, 4> corners{0, 1, 2, 3};
  binary += '\x04';
  binary.append(reinterpret_cast<const char*>(corners.data()), sizeof corners);
  expect_square("ascii.ply", ascii + "4 0 1 2 3\n");
  expect_square("binary.ply", binary);
  expect_square("normals.off", off + "4 0 1 2 3\n");
  // Positions must be.
  std::string bad = kPly;
  bad.replace(bad.find("1 1 0\n"), 5, "1 nan 0");
  expect_refused("bad.ply", "vertex 2 is not finite", bad);
}

TEST_F(MeshDialects, ByteOrderMarks) {
  const std::string mark = "\xEF\xBB\xBF";
  expect_square("mark.off", mark + kOff);
  expect_square("mark.obj", mark + kObjVertices + "f 1 2 3 4\n");
  expect_square("mark.ply", mark + kPly);
  const TriangleMesh stl = read_mesh(folder_.file(
      "mark.stl", mark + "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex "
                         "1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid s\n"));
  EXPECT_EQ(stl.triangles.size(), 1U);
  expect_refused("mark.off", "empty", mark);
}

TEST_F(MeshDialects, PlyLayouts) {
  using test::with;
  expect_square("integers.ply", with(kPly, "float x", "uchar x"));
  expect_square("index.ply", with(kPly, "uchar int vertex_indices", "int uint vertex_index"));
  expect_square("short.ply", with(kPly, "uchar int", "uint16 uint8"));
  expect_square("plural.ply", with(with(kPly, "element vertex", "element vertices"), "element face",
                                   "element faces"));
  // Other elements in between, and faces before the vertices.
  expect_square("more.ply", with(with(kPly, "element face",
                                      "element edge 1\nproperty int a\nproperty "
                                      "list uchar float b\nelement face"),
                                 "4 0 1 2 3\n", "7 2 0.5 1.5\n4 0 1 2 3\n"));
  expect_square("first.ply",
                "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                "element vertex 4\nproperty double z\nproperty double x\nproperty double y\n"
                "end_header\n4 0 1 2 3\n0 0 0\n0 1 0\n0 1 1\n0 0 1\n");
  expect_refused("float.ply", "whole numbers", with(kPly, "uchar int", "uchar float"));
  expect_refused("half.ply", "half.ply:14: '1.5' is not a whole", with(kPly, "4 0 1 ", "4 0 1.5 "));
  expect_refused("list.ply", "list.ply:14: ", with(kPly, "4 0 1 2 3", "1000000000 0 1 2 3"));
  expect_refused("cut.ply", "ends before", with(kPly, "4 0 1 2 3\n", ""));
  expect_refused("range.ply", "face 0 has an index out of range", with(kPly, "0 1 2 3", "0 1 2 4"));
}

// A list of 2^32 - 1 corners in a file of some bytes costs nothing.
TEST_F(MeshDialects, BinaryListsThatPromiseTooMuch) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
  bytes += std::string(12, '\0') + "\xff\xff\xff\xff" + std::string(64, '\0');
  expect_refused("list.ply", "the file ends before its last element", bytes);
}

TEST_F(MeshDialects, PlacementNamesTheFile) {
  const auto path = folder_.file("point.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
  expect_error(ErrorCode::invalid_argument, path.string() + ": the mesh has no extent to scale",
               [&] { (void)read_mesh(path, {.longest_side = 1}); });
  expect_error(ErrorCode::invalid_argument, "not negative, not -1e-09",
               [&] { (void)read_mesh(path, {.longest_side = -1e-9}); });
  const auto square = folder_.file("square.off", kOff);
  EXPECT_EQ(read_mesh(square, {.longest_side = 2}).vertices[2], (std::array<double, 3>{2, 2, 0}));
  EXPECT_EQ(read_mesh(square, {.center = true}).vertices,
            placed(read_mesh(square), {.center = true}).vertices);
}

}  // namespace
}  // namespace viewgain
