// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/surface_files.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "viewgain/formats/ply.hpp"
#include "viewgain/planner/point_arrays.hpp"

namespace viewgain {
namespace {

std::vector<float> sigmas_along(const std::vector<std::array<double, 3>>& normals,
                                const std::vector<SymmetricMatrix3>& covariances) {
  std::vector<float> sigmas;
  sigmas.reserve(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d n(normals[i][0], normals[i][1], normals[i][2]);
    sigmas.push_back(static_cast<float>(std::sqrt(n.dot(covariances[i] * n))));
  }
  return sigmas;
}

}  // namespace

void write_surfaces(const SurfaceModel& model, const std::filesystem::path& surface_file,
                    const std::filesystem::path& points_file) {
  const PointArrays points = arrays_of(model.points());
  const SurfaceMesh& surface = model.surface();
  std::vector<SymmetricMatrix3> of_vertices;
  of_vertices.reserve(surface.source.size());
  for (const std::uint32_t i : surface.source) of_vertices.push_back(points.covariances[i]);
  write_ply(surface_file, {surface.vertices, surface.normals,
                           sigmas_along(surface.normals, of_vertices), surface.triangles});
  write_ply(points_file,
            {points.positions, points.normals, sigmas_along(points.normals, points.covariances)});
}

}  // namespace viewgain
