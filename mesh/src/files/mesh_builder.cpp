// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_builder.hpp"

#include <cmath>
#include <limits>

#include "ear_clipping.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {

constexpr double kBeyond = 1e30;  // single precision has room for it

void MeshBuilder::fail(std::size_t line, const std::string& what) const {
  throw Error(ErrorCode::format,
              name_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

void MeshBuilder::add_vertex(const std::array<double, 3>& p, std::size_t line) {
  for (const double x : p) {
    if (std::abs(x) < kBeyond) continue;
    fail(line, "a coordinate of vertex " + std::to_string(vertices()) +
                   " is not finite, or 1e30 and more");
  }
  mesh_.vertices.push_back(p);
}

void MeshBuilder::add_corner(double index, std::size_t line) {
  if (!(index >= 0 && index < std::numeric_limits<std::uint32_t>::max())) {
    fail(line, "face " + std::to_string(faces_.size()) + " has an index out of range");
  }
  corners_.push_back(static_cast<std::uint32_t>(index));
}

TriangleMesh MeshBuilder::finish() && {
  split_faces();
  if (mesh_.triangles.empty()) fail(0, "the mesh has no faces");
  drop_unused();
  return std::move(mesh_);
}

void MeshBuilder::split_faces() {
  EarClipping polygon;
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const std::uint32_t* const corners = corners_.data() + begin;
    const std::size_t count = face.end - begin;
    begin = face.end;
    const auto number = [&] { return "face " + std::to_string(&face - faces_.data()); };
    polygon.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if (corners[i] >= vertices()) {
        fail(face.line, number() + " has an index out of range, the file has " +
                            std::to_string(vertices()) + " vertices");
      }
      if (count > 3) polygon.add(mesh_.vertices[corners[i]]);
    }
    if (count == 3) mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
    if (count <= 3) continue;
    if (!polygon.split()) fail(face.line, number() + " " + polygon.reason());
    for (const auto& t : polygon.triangles()) {
      mesh_.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    }
  }
}

void MeshBuilder::drop_unused() {
  std::vector<std::uint32_t> place(vertices(), 0);
  for (const auto& t : mesh_.triangles) {
    for (const std::uint32_t corner : t) place[corner] = 1;
  }
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == 0) continue;
    mesh_.vertices[used] = mesh_.vertices[i];
    place[i] = used++;
  }
  mesh_.vertices.resize(used);
  for (auto& t : mesh_.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
}

}  // namespace viewgain::detail
