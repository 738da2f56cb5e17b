// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "ply_mesh.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "mesh_builder.hpp"
#include "viewgain/support/ply_file.hpp"

namespace viewgain::detail {
namespace {

std::size_t find_element(const PlyFile& file, std::string_view name, std::string_view other_name) {
  const auto& elements = file.elements();
  const auto found = std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) {
    return e.name == name || e.name == other_name;
  });
  if (found == elements.end())
    file.fail("the mesh has no faces: there is no element " + quoted(name));
  return static_cast<std::size_t>(found - elements.begin());
}

}  // namespace

TriangleMesh ply_mesh(std::string_view bytes, const std::string& name) {
  PlyFile file(bytes, name);
  const std::size_t vertices = find_element(file, "vertex", "vertices");
  const std::size_t faces = find_element(file, "face", "faces");
  std::array<std::size_t, 3> xyz{};
  for (const auto& [axis, place] : {std::pair("x", &xyz[0]), {"y", &xyz[1]}, {"z", &xyz[2]}}) {
    const auto property = file.elements()[vertices].find(axis, false);
    if (!property) file.fail("the vertices have no property " + quoted(axis));
    *place = *property;
  }
  auto corners = file.elements()[faces].find("vertex_indices", true);
  if (!corners) corners = file.elements()[faces].find("vertex_index", true);
  if (!corners ||
      file.elements()[faces].properties[*corners].type.kind == ScalarType::Kind::floating) {
    file.fail("the faces have no list 'vertex_indices' of whole numbers");
  }

  MeshBuilder mesh(name, file.elements()[vertices].count);
  file.read(std::max(vertices, faces) + 1, [&](std::size_t element, const PlyRow& row) {
    if (element == vertices) {
      mesh.add_vertex({row.scalar(xyz[0]), row.scalar(xyz[1]), row.scalar(xyz[2])});
    } else if (element == faces) {
      mesh.add_face(row.list(*corners));
    }
  });
  return std::move(mesh).finish();
}

}  // namespace viewgain::detail
