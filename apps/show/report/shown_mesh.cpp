// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/report/shown_mesh.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "show/report/blocks.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

// The cell of each vertex, numbered in the order in which they come.
std::vector<std::uint32_t> cells_of(const std::vector<Vector3d>& vertices, double side,
                                    std::size_t& count) {
  std::map<std::array<std::int64_t, 3>, std::uint32_t> numbers;
  std::vector<std::uint32_t> cells;
  cells.reserve(vertices.size());
  for (const Vector3d& p : vertices) {
    const std::array<std::int64_t, 3> at{std::llround(p.x() / side), std::llround(p.y() / side),
                                         std::llround(p.z() / side)};
    cells.push_back(
        numbers.try_emplace(at, static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  count = numbers.size();
  return cells;
}

ShownMesh merged(const ShownMesh& mesh, const std::vector<std::uint32_t>& cells,
                 std::size_t count) {
  ShownMesh result;
  result.vertices.assign(count, Vector3d::Zero());
  result.sigma.assign(mesh.sigma.empty() ? 0 : count, 0.0);
  result.error.assign(mesh.error.empty() ? 0 : count, 0.0);
  std::vector<double> members(count, 0.0);
  for (const std::uint32_t cell : cells) ++members[cell];
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double share = 1 / members[cells[i]];
    result.vertices[cells[i]] += share * mesh.vertices[i];
    if (!mesh.sigma.empty()) result.sigma[cells[i]] += share * mesh.sigma[i];
    if (!mesh.error.empty()) result.error[cells[i]] += share * mesh.error[i];
  }
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> moved{cells[t[0]], cells[t[1]], cells[t[2]]};
    if (moved[0] == moved[1] || moved[1] == moved[2] || moved[2] == moved[0]) continue;
    result.triangles.push_back(moved);
  }
  return result;
}

}  // namespace

ShownMesh thinned(ShownMesh mesh, std::size_t most) {
  if (mesh.vertices.size() <= most) return mesh;
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.vertices) box.extend(p);
  // Vertices of a surface are about as many as the squares of its box's diagonal.
  double side = box.diagonal().norm() / std::sqrt(static_cast<double>(most));
  std::size_t count = 0;
  std::vector<std::uint32_t> cells = cells_of(mesh.vertices, side, count);
  while (count > most) cells = cells_of(mesh.vertices, side *= 1.15, count);
  return merged(mesh, cells, count);
}

Json to_json(const ShownMesh& mesh) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  Json json{{"vertices", point_block(mesh.vertices)}, {"triangles", index_block(indices, 3)}};
  if (!mesh.sigma.empty()) json["sigma"] = shade_block(mesh.sigma);
  if (!mesh.error.empty()) json["error"] = shade_block(mesh.error);
  return json;
}

}  // namespace viewgain::app
