// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/surface_files.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "viewgain/formats/ply.hpp"
#include "viewgain/planner/point_arrays.hpp"

namespace viewgain {
namespace {

std::vector<float> point_sigmas(const PointArrays& points) {
  std::vector<float> sigmas;
  sigmas.reserve(points.normals.size());
  for (std::size_t i = 0; i < points.normals.size(); ++i) {
    const Eigen::Vector3d n(points.normals[i].data());
    sigmas.push_back(static_cast<float>(std::sqrt(n.dot(points.covariances[i] * n))));
  }
  return sigmas;
}

}  // namespace

void write_surfaces(const SurfaceMesh& surface, const std::vector<FusedPoint>& points,
                    const std::filesystem::path& surface_file,
                    const std::filesystem::path& points_file) {
  if (!surface_file.empty()) {
    const std::vector<double> sigmas = surface_sigmas(surface, points);
    write_ply(surface_file, {surface.vertices, surface.normals,
                             std::vector<float>(sigmas.begin(), sigmas.end()), surface.triangles});
  }
  if (points_file.empty()) return;
  const PointArrays arrays = arrays_of(points);
  write_ply(points_file, {arrays.positions, arrays.normals, point_sigmas(arrays)});
}

void write_surfaces(const SurfaceModel& model, const std::filesystem::path& surface_file,
                    const std::filesystem::path& points_file) {
  write_surfaces(model.surface(), model.points(), surface_file, points_file);
}

}  // namespace viewgain
