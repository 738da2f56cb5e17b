// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_at.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewgain/core/noise.hpp"

namespace viewgain::detail {
namespace {

constexpr int kRadius = 2;         // of the neighbourhood [pixels]
constexpr double kSteepest = 2.0;  // depth over distance across the view
constexpr int kFewest = 6;

}  // namespace

std::optional<Eigen::Vector3d> surface_at(const Readings& readings, std::size_t pixel) {
  const int width = readings.row_length();
  if (width == 0) return std::nullopt;
  const int height = static_cast<int>(readings.size()) / width;
  const int u = static_cast<int>(pixel) % width, v = static_cast<int>(pixel) / width;
  const PinholeCamera& camera = readings.sensor().camera;
  const Eigen::Vector3d& point = readings.point(pixel);
  const MeasurementSigmas sigmas = readings.sigmas(pixel);
  const double noise = kTaperSigmas * std::numbers::sqrt2 * sigmas.axial;
  const double slope = kSteepest * point.z() / std::min(camera.fx, camera.fy);

  double n = 0, z = 0, uu = 0, uv = 0, vv = 0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero(), pz = Eigen::Vector2d::Zero();
  for (int j = std::max(-kRadius, -v); j <= std::min(kRadius, height - 1 - v); ++j) {
    for (int i = std::max(-kRadius, -u); i <= std::min(kRadius, width - 1 - u); ++i) {
      const std::size_t at = pixel + static_cast<std::size_t>(j * width + i);
      if (readings.kind(at) != PixelKind::reading) continue;
      const double dz = readings.point(at).z() - point.z();
      if (std::abs(dz) > slope * std::sqrt(i * i + j * j) + noise) continue;
      n += 1, z += dz;
      p += Eigen::Vector2d(i, j), pz += dz * Eigen::Vector2d(i, j);
      uu += i * i, uv += i * j, vv += j * j;
    }
  }
  if (n < kFewest) return std::nullopt;
  // Depth = z + gradient · (pixel - p), p and z the means.
  p /= n, z /= n;
  pz -= n * z * p;
  uu -= n * p.x() * p.x(), uv -= n * p.x() * p.y(), vv -= n * p.y() * p.y();
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1)) return std::nullopt;
  const Eigen::Vector2d gradient((vv * pz.x() - uv * pz.y()) / determinant,
                                 (uu * pz.y() - uv * pz.x()) / determinant);

  const double off = z - gradient.dot(p);  // of the plane from the reading, in depth [m]
  const double depth = point.z() + off;
  const Eigen::Vector3d ray = point / point.z();
  const Eigen::Vector3d along_u = gradient.x() * ray + Eigen::Vector3d(depth / camera.fx, 0, 0);
  const Eigen::Vector3d along_v = gradient.y() * ray + Eigen::Vector3d(0, depth / camera.fy, 0);
  const Eigen::Vector3d normal = along_u.cross(along_v).normalized();  // away from the camera
  const double cosine = normal.dot(readings.direction(pixel));
  if (!(cosine >= kMinCosIncidence)) return std::nullopt;
  const double sigma = std::sqrt(sigmas.axial * sigmas.axial * cosine * cosine +
                                 sigmas.lateral * sigmas.lateral * (1 - cosine * cosine));
  const double distance = off * normal.dot(ray);
  if (std::abs(distance) > kTaperSigmas * sigma) return std::nullopt;
  return point + distance * normal;
}

}  // namespace viewgain::detail
