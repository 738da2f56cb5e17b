// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/mesh/mesh_io.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "mesh_builder.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

struct Bounds {
  std::array<double, 3> min, max;
};

Bounds bounds_of(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Bounds bounds{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const auto& vertex : mesh.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.min[k] = std::min(bounds.min[k], vertex[k]);
      bounds.max[k] = std::max(bounds.max[k], vertex[k]);
    }
  }
  return bounds;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string extension = lower_case_extension(path);
  if (extension != ".off" && extension != ".obj" && extension != ".stl" && extension != ".ply") {
    throw Error(ErrorCode::format, name + ": not a mesh file (.off, .obj, .stl, .ply)");
  }
  std::string bytes = file_bytes(path);
  // Some editors put a byte order mark before text; no format of ours begins with one.
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (bytes.empty()) throw Error(ErrorCode::format, name + ": the file is empty");
  if (extension == ".off") return detail::off_mesh(bytes, name);
  if (extension == ".obj") return detail::obj_mesh(bytes, name);
  if (extension == ".stl") return detail::stl_mesh(bytes, name);
  return detail::ply_mesh(bytes, name);
}

TriangleMesh read_mesh(const std::filesystem::path& path, const MeshPlacement& placement) {
  TriangleMesh mesh = read_mesh(path);
  try {
    return placed(std::move(mesh), placement);
  } catch (const Error& error) {
    throw Error(error.code(), path.string() + ": " + error.what());
  }
}

TriangleMesh placed(TriangleMesh mesh, const MeshPlacement& placement) {
  if (!std::isfinite(placement.longest_side) || placement.longest_side < 0) {
    refuse("the longest side must be finite and not negative, not " +
           short_text(placement.longest_side));
  }
  for (auto& v : mesh.vertices) {
    // Cyclic permutations keep the orientation of the faces.
    if (placement.up == UpAxis::x) v = {v[1], v[2], v[0]};
    if (placement.up == UpAxis::y) v = {v[2], v[0], v[1]};
  }
  if (placement.longest_side > 0) {
    const Bounds bounds = bounds_of(mesh);
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, bounds.max[k] - bounds.min[k]);
    const double scale = placement.longest_side / extent;
    if (!(extent > 0) || !std::isfinite(scale)) refuse("the mesh has no extent to scale");
    for (auto& v : mesh.vertices) {
      for (double& x : v) x *= scale;
    }
  }
  if (placement.center && !mesh.vertices.empty()) {
    const Bounds bounds = bounds_of(mesh);
    for (auto& v : mesh.vertices) {
      for (std::size_t k = 0; k < 3; ++k) v[k] -= 0.5 * (bounds.min[k] + bounds.max[k]);
    }
  }
  return mesh;
}

}  // namespace viewgain
