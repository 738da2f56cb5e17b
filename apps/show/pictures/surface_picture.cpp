// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "show/pictures/surface_picture.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "show/pictures/ray_tracer.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMaxEllipsoids = 5'000;

std::array<double, 3> array_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

double share_of(double sigma, const std::array<double, 2>& range) {
  return range[1] > range[0] ? (sigma - range[0]) / (range[1] - range[0]) : 0.5;
}

// A sphere of radius 1 by circles of latitude.
struct UnitSphere {
  std::vector<Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  UnitSphere() {
    constexpr std::uint32_t kRings = 6, kSides = 10;
    for (std::uint32_t i = 0; i <= kRings; ++i) {
      for (std::uint32_t j = 0; j < kSides; ++j) {
        const double polar = std::numbers::pi * i / kRings;
        const double azimuth = 2 * std::numbers::pi * j / kSides;
        vertices.emplace_back(std::sin(polar) * std::cos(azimuth),
                              std::sin(polar) * std::sin(azimuth), std::cos(polar));
        if (i == kRings) continue;
        const std::uint32_t a = i * kSides + j, b = i * kSides + (j + 1) % kSides;
        if (i > 0) triangles.push_back({a, a + kSides, b});
        if (i + 1 < kRings) triangles.push_back({b, a + kSides, b + kSides});
      }
    }
  }
};

void add_ellipsoids(PaintedMesh& scene, const SurfacePicture& picture, const HeatPaints& paints) {
  const UnitSphere sphere;
  const std::vector<FusedPoint>& points = *picture.points;
  const std::size_t count = std::min(points.size(), kMaxEllipsoids);
  for (std::size_t k = 0; k < count; ++k) {
    const FusedPoint& point = points[k * points.size() / count];
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(point.covariance.matrix());
    const Vector3d sigmas = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
    const Vector3d lengths = picture.ellipsoid_sigmas * sigmas;
    std::vector<std::array<double, 3>> vertices, normals;
    for (const Vector3d& s : sphere.vertices) {
      vertices.push_back(array_of(Vector3d(point.position.data()) +
                                  axes.eigenvectors() * lengths.cwiseProduct(s)));
      normals.push_back(
          array_of((axes.eigenvectors() * s.cwiseQuotient(lengths.cwiseMax(1e-9))).normalized()));
    }
    scene.add_surface(vertices, normals, sphere.triangles,
                      paints.at(share_of(sigmas.z(), picture.sigma_range)));
  }
}

}  // namespace

RgbImage draw(const SurfacePicture& picture, const Viewer& viewer, const ExecConfig& exec) {
  PaintedMesh scene;
  const HeatPaints paints(scene, true);
  const SurfaceMesh& surface = picture.surface;
  if (surface.triangles.empty()) {
    throw Error(ErrorCode::invalid_argument, "the map has no surface to draw yet");
  }
  if (picture.points != nullptr) {
    add_ellipsoids(scene, picture, paints);
  } else if (picture.sigmas.empty()) {
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

std::vector<double> longest_sigmas(const std::vector<FusedPoint>& points) {
  std::vector<double> sigmas;
  sigmas.reserve(points.size());
  for (const FusedPoint& point : points) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(point.covariance.matrix(),
                                                       Eigen::EigenvaluesOnly);
    sigmas.push_back(std::sqrt(std::max(0.0, axes.eigenvalues().z())));
  }
  return sigmas;
}

}  // namespace viewgain::app
