// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/mesh/mesh_io.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
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

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, MeshRepairs* repairs) {
  const std::string name = path.string();
  const std::string extension = lower_case_extension(path);
  if (extension != ".off" && extension != ".obj" && extension != ".stl" && extension != ".ply") {
    throw Error(ErrorCode::format, name + ": a mesh must have the ending .off, .obj, .stl or .ply");
  }
  std::string bytes = file_bytes(path);
  // Some editors write a byte order mark before text; no mesh format begins with one.
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (bytes.empty()) throw Error(ErrorCode::format, name + ": the file is empty");
  MeshRepairs unasked;
  MeshRepairs& made = repairs != nullptr ? *repairs : unasked;
  if (extension == ".off") return detail::off_mesh(bytes, name, made);
  if (extension == ".obj") return detail::obj_mesh(bytes, name, made);
  if (extension == ".stl") return detail::stl_mesh(bytes, name, made);
  return detail::ply_mesh(bytes, name, made);
}

TriangleMesh read_mesh(const std::filesystem::path& path, const MeshPlacement& placement,
                       MeshRepairs* repairs) {
  TriangleMesh mesh = read_mesh(path, repairs);
  try {
    return placed(std::move(mesh), placement);
  } catch (const Error& error) {
    throw Error(error.code(), path.string() + ": " + error.what());
  }
}

Box bounds_of(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Box box{mesh.vertices.front(), mesh.vertices.front()};
  for (const auto& v : mesh.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], v[k]);
      box.max[k] = std::max(box.max[k], v[k]);
    }
  }
  return box;
}

double longest_side(const Box& box) {
  const auto& [min, max] = box;
  return std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]});
}

TriangleMesh placed(TriangleMesh mesh, const MeshPlacement& placement) {
  if (!std::isfinite(placement.longest_side) || placement.longest_side < 0) {
    refuse("the longest side must be at least 0 and finite, not " +
           short_text(placement.longest_side));
  }
  for (auto& v : mesh.vertices) {
    // Cyclic permutations keep the orientation of the faces.
    if (placement.up == UpAxis::x) v = {v[1], v[2], v[0]};
    if (placement.up == UpAxis::y) v = {v[2], v[0], v[1]};
  }
  if (placement.longest_side > 0) {
    const double extent = longest_side(bounds_of(mesh));
    const double scale = placement.longest_side / extent;
    if (!(extent > 0) || !std::isfinite(scale))
      refuse("the mesh cannot be scaled, because its extent is 0 or not finite");
    for (auto& v : mesh.vertices) {
      for (double& x : v) x *= scale;
    }
  }
  if (placement.center && !mesh.vertices.empty()) {
    const Box bounds = bounds_of(mesh);
    for (auto& v : mesh.vertices) {
      for (std::size_t k = 0; k < 3; ++k) v[k] -= 0.5 * (bounds.min[k] + bounds.max[k]);
    }
  }
  return mesh;
}

}  // namespace viewgain
