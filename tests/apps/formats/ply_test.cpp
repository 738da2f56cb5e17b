// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/ply.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain {
namespace {

class Ply : public testing::Test {
 protected:
  test::TemporaryFolder own_;
  const std::filesystem::path folder_ = own_.path();
};

SurfaceMesh tetrahedron() {
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1.0 / 3, 0, 0}, {0, 0.1, 0}, {0, 0, 1e-7}};
  mesh.normals = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.source = {0, 1, 2, 3};
  return mesh;
}

PlyArrays arrays_of(const SurfaceMesh& mesh, std::span<const float> sigma) {
  return {mesh.vertices, mesh.normals, sigma, mesh.triangles};
}

template <typename Value>
Value value_at(const std::string& bytes, std::size_t at) {
  Value value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

TEST_F(Ply, MeshComesBackExactly) {
  const SurfaceMesh mesh = tetrahedron();
  for (const std::vector<float>& sigma :
       {std::vector<float>{}, std::vector<float>{0.5F, 0.25F, 0.125F, 0.001F}}) {
    const auto path = folder_ / "surface.ply";
    write_ply(path, arrays_of(mesh, sigma));
    const TriangleMesh read = read_mesh(path);
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.triangles, mesh.triangles);
  }
  EXPECT_EQ(own_.entries(), 1);
}

TEST_F(Ply, OtherEndingsAreRefused) {
  for (const std::string name : {"surface.stl", "surface.obj", "surface", "surface.ply.gz"}) {
    test::expect_error(ErrorCode::invalid_argument, "must have the ending .ply",
                       [&] { write_ply(folder_ / name, arrays_of(tetrahedron(), {})); });
  }
  EXPECT_EQ(own_.entries(), 0);
  write_ply("/dev/null", arrays_of(tetrahedron(), {}));
}

TEST_F(Ply, BytesAreAsTheHeaderSays) {
  const SurfaceMesh mesh = tetrahedron();
  const std::vector<float> sigma{0.5F, 0.25F, 0.125F, 0.001F};
  const auto path = folder_ / "surface.ply";
  write_ply(path, arrays_of(mesh, sigma));
  const std::string bytes = test::read_all(path);
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end) + end.size();
  const std::string header = bytes.substr(0, data);
  EXPECT_EQ(header.find("ply\nformat binary_"), 0U);
  EXPECT_NE(header.find("element vertex 4\nproperty double x\nproperty double y\nproperty double "
                        "z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty "
                        "float sigma\nelement face 4\nproperty list uchar int vertex_indices\n"),
            std::string::npos);
  constexpr std::size_t kVertex = 3 * 8 + 4 * 4, kFace = 1 + 3 * 4;
  ASSERT_EQ(bytes.size(), data + 4 * kVertex + 4 * kFace);
  EXPECT_EQ(value_at<double>(bytes, data + kVertex), 1.0 / 3);
  EXPECT_EQ(value_at<float>(bytes, data + 3 * kVertex + 24 + 8), 0.5F);
  EXPECT_EQ(value_at<float>(bytes, data + 3 * kVertex + 24 + 12), 0.001F);
  EXPECT_EQ(value_at<std::uint8_t>(bytes, data + 4 * kVertex), 3);
  EXPECT_EQ(value_at<std::int32_t>(bytes, data + 4 * kVertex + 5), 2);
}

TEST_F(Ply, PointsWithAndWithoutNormals) {
  const SurfaceMesh mesh = tetrahedron();
  const std::vector<float> sigma(4, 0.5F);
  const std::string end = "end_header\n";
  for (const bool normals : {false, true}) {
    for (const bool sigmas : {false, true}) {
      const auto path = folder_ / "points.ply";
      PlyArrays points{mesh.vertices};
      if (normals) points.normals = mesh.normals;
      if (sigmas) points.sigma = sigma;
      write_ply(path, points);
      const std::string bytes = test::read_all(path);
      EXPECT_EQ(bytes.find("face"), std::string::npos);
      const std::size_t vertex = 24U + (normals ? 12U : 0U) + (sigmas ? 4U : 0U);
      EXPECT_EQ(bytes.size(), bytes.find(end) + end.size() + 4 * vertex);
    }
  }
  write_ply(folder_ / "none.ply", {});
  EXPECT_NE(test::read_all(folder_ / "none.ply").find("element vertex 0\n"), std::string::npos);
}

TEST_F(Ply, BadInputIsRefusedAndLeavesNoFile) {
  const auto path = folder_ / "surface.ply";
  SurfaceMesh mesh = tetrahedron();
  const std::vector<float> three(3, 0.5F);
  const auto expect_refused = [&](const std::string& what, std::span<const float> sigma) {
    test::expect_error(ErrorCode::invalid_argument, path.string() + ": " + what,
                       [&] { write_ply(path, arrays_of(mesh, sigma)); });
  };
  expect_refused("one value per point is required; points: 4, sigmas: 3", three);
  mesh.triangles[3][1] = 4;
  expect_refused("a triangle has vertex 4; it must be less than the number of points, 4", {});
  mesh = tetrahedron();
  mesh.normals.pop_back();
  expect_refused("one value per point is required; points: 4, normals: 3", {});
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
  test::expect_error(ErrorCode::io, "",
                     [&] { write_ply(folder_ / "no such folder" / "surface.ply", {}); });
}

}  // namespace
}  // namespace viewgain
