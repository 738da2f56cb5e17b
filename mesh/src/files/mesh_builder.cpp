// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_builder.hpp"

#include <cmath>
#include <limits>
#include <span>

#include "polygon_fill.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {

constexpr double kBeyond = 1e30;  // fits in single precision

void MeshBuilder::fail(std::size_t line, const std::string& what) const {
  throw Error(ErrorCode::format,
              name_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

void MeshBuilder::add_vertex(const std::array<double, 3>& p, std::size_t line) {
  for (const double x : p) {
    if (std::abs(x) < kBeyond) continue;
    fail(line,
         "a coordinate of vertex " + std::to_string(vertices()) + " must be finite and below 1e30");
  }
  mesh_.vertices.push_back(p);
}

void MeshBuilder::add_corner(double index, std::size_t line) {
  if (!(index >= 0 && index < std::numeric_limits<std::uint32_t>::max())) {
    fail(line, "face " + std::to_string(faces_.size()) + " has an index out of range");
  }
  corners_.push_back(static_cast<std::uint32_t>(index));
}

TriangleMesh MeshBuilder::finish(MeshRepairs& repairs) && {
  split_faces();
  if (mesh_.triangles.empty() && repairs_.dropped_faces > 0) {
    fail(0, "all faces of the mesh have the area 0");
  }
  if (mesh_.triangles.empty()) fail(0, "the mesh has no faces");
  drop_unused();
  repairs = repairs_;
  return std::move(mesh_);
}

void MeshBuilder::split_faces() {
  // Faces of real files take some tens of steps per corner and few crossings. A file that needs
  // more than this would fill the memory or take minutes.
  FillBudget budget{10'000'000 + 300 * corners_.size(), 100'000 + corners_.size()};
  PolygonFill polygon;
  const std::size_t in_file = vertices();
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const std::span corners = std::span(corners_).subspan(begin, face.end - begin);
    begin = face.end;
    const auto number = [&] { return "face " + std::to_string(&face - faces_.data()); };
    for (const std::uint32_t corner : corners) {
      if (corner < in_file) continue;
      fail(face.line, number() + " has an index out of range; the file has " +
                          std::to_string(in_file) + " vertices");
    }
    if (corners.size() < 3) continue;
    const std::size_t triangles = mesh_.triangles.size();
    try {
      if (polygon.fill(corners, mesh_, budget)) ++repairs_.mended_faces;
    } catch (const Error& error) {
      fail(face.line, number() + " " + error.what());
    }
    if (mesh_.triangles.size() == triangles) ++repairs_.dropped_faces;
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
