// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "show/pictures/surface_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "show/pictures/ray_tracer.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

double share_of(double sigma, const std::array<double, 2>& range) {
  return range[1] > range[0] ? (sigma - range[0]) / (range[1] - range[0]) : 0.5;
}

}  // namespace

RgbImage draw(const SurfacePicture& picture, const Viewer& viewer, const ExecConfig& exec) {
  PaintedMesh scene;
  const HeatPaints paints(scene);
  const SurfaceMesh& surface = picture.surface;
  if (surface.triangles.empty()) {
    throw Error(ErrorCode::invalid_argument, "the map has no surface to draw yet");
  }
  if (picture.sigmas.empty()) {
    scene.add_surface(surface.vertices, surface.normals, surface.triangles,
                      scene.add_paint({.color = {0.58, 0.58, 0.56}, .back_side = 0.55}));
  } else {
    std::vector<std::uint8_t> paint_of_triangle;
    for (const auto& t : surface.triangles) {
      const double sigma = (picture.sigmas[t[0]] + picture.sigmas[t[1]] + picture.sigmas[t[2]]) / 3;
      paint_of_triangle.push_back(paints.at(share_of(sigma, picture.sigma_range)));
    }
    scene.add_surface(surface.vertices, surface.normals, surface.triangles, paint_of_triangle);
  }
  PinholeCamera camera = picture_camera(viewer.width);
  std::vector<Vector3d> in_sight;
  Eigen::AlignedBox3d box;
  for (const auto& p : surface.vertices) {
    in_sight.emplace_back(p.data());
    box.extend(in_sight.back());
  }
  const Pose T_world_viewer = place_viewer(in_sight, viewer.direction(), camera);
  return render(scene, camera, T_world_viewer, 0.25 * box.diagonal().norm(), exec);
}

std::array<double, 2> usual_range(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.02), at(0.98)};
}

}  // namespace viewgain::app
