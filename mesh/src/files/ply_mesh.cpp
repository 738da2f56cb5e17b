// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "mesh_builder.hpp"
#include "viewgain/support/ply_file.hpp"

namespace viewgain::detail {
namespace {

std::optional<std::size_t> find_element(const PlyFile& file, std::string_view name,
                                        std::string_view other_name) {
  const auto& elements = file.elements();
  const auto is_it = [&](const PlyElement& e) { return e.name == name || e.name == other_name; };
  const auto found = std::find_if(elements.begin(), elements.end(), is_it);
  if (found == elements.end()) return std::nullopt;
  if (std::any_of(found + 1, elements.end(), is_it)) {
    file.fail("there is more than one element " + quoted(name));
  }
  return static_cast<std::size_t>(found - elements.begin());
}

/// Column with the vertex indices of faces or strips.
std::size_t indices_of(const PlyFile& file, std::size_t element) {
  const PlyElement& faces = file.elements()[element];
  auto corners = faces.find("vertex_indices", true);
  if (!corners) corners = faces.find("vertex_index", true);
  if (!corners || faces.properties[*corners].type.kind == ScalarType::Kind::floating) {
    file.fail("the element " + quoted(faces.name) +
              " has no list 'vertex_indices' of whole numbers");
  }
  return *corners;
}

/// Each triangle shares an edge with the previous triangle and has the opposite orientation. -1
/// ends a strip, and a repeated corner joins two strips.
void add_strips(MeshBuilder& mesh, std::span<const double> corners, std::size_t line) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] == -1) begin = i + 1;
    if (corners[i] == -1 || i < begin + 2) continue;
    std::array t{corners[i - 2], corners[i - 1], corners[i]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if ((i - begin) % 2 == 1) std::swap(t[0], t[1]);
    for (const double index : t) mesh.add_corner(index, line);
    mesh.end_face(line);
  }
}

}  // namespace

TriangleMesh ply_mesh(std::string_view bytes, const std::string& name, MeshRepairs& repairs) {
  PlyFile file(bytes, name);
  const auto vertices = find_element(file, "vertex", "vertices");
  const auto faces = find_element(file, "face", "faces");
  const auto strips = find_element(file, "tristrips", "tristrip");
  if (!vertices) file.fail("the element 'vertex' is missing");
  if (!faces && !strips) file.fail("the mesh has no faces: the element 'face' is missing");
  std::array<std::size_t, 3> xyz{};
  for (const auto& [axis, place] : {std::pair("x", &xyz[0]), {"y", &xyz[1]}, {"z", &xyz[2]}}) {
    const auto property = file.elements()[*vertices].find(axis, false);
    if (!property) file.fail("the vertices have no property " + quoted(axis));
    *place = *property;
  }
  std::size_t of_faces = 0, of_strips = 0;
  if (faces) of_faces = indices_of(file, *faces);
  if (strips) of_strips = indices_of(file, *strips);

  MeshBuilder mesh(name);
  file.read(file.elements().size(), [&](std::size_t element, const PlyRow& row) {
    const std::size_t line = file.line();
    if (element == *vertices) {
      mesh.add_vertex({row.scalar(xyz[0]), row.scalar(xyz[1]), row.scalar(xyz[2])}, line);
    } else if (element == faces) {
      for (const double index : row.list(of_faces)) mesh.add_corner(index, line);
      mesh.end_face(line);
    } else if (element == strips) {
      add_strips(mesh, row.list(of_strips), line);
    }
  });
  return std::move(mesh).finish(repairs);
}

}  // namespace viewgain::detail
