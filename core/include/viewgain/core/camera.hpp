// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Pinhole camera with OpenCV's distortion model. Optical frame: x right, y down, z forward. Pixel
/// (0,0) has its centre at (0,0), as in OpenCV. A value type. Members require a camera that passes
/// validate() and check nothing unless stated otherwise.
struct VIEWGAIN_EXPORT PinholeCamera {
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  double fx = 0, fy = 0;               ///< focal lengths [px]
  double cx = 0, cy = 0;               ///< principal point [px]
  std::array<double, 5> distortion{};  ///< coefficients k1 k2 p1 p2 k3

  /// Whether any coefficient differs from 0.
  [[nodiscard]] bool has_distortion() const { return distortion != std::array<double, 5>{}; }

  /// Throws Error(invalid_argument) naming the field unless sizes are in 1..16384, there are at
  /// most 2^24 pixels, focal lengths are positive and all numbers are finite. A table of rays takes
  /// 24 bytes per pixel.
  void validate() const;

  /// Direction (x, y, 1) in the camera frame of the ray through pixel coordinates (u, v) [px], with
  /// the distortion removed. Iterates to 1e-12. NaN if the distortion model folds between the
  /// optical axis and this pixel, so that the pixel has no ray. Without distortion the result is
  /// exact and cheap.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const;

  /// Pixel coordinates (u, v) [px] of the camera-frame point p [m], with distortion; NaN unless p.z
  /// > 0. As in OpenCV, a strong distortion can fold a point far outside the view into the image.
  /// Inline, because the alignment of an Eigen Vector2d depends on the caller's compiler flags.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    Eigen::Vector2d pixel;
    project(p_camera, pixel.x(), pixel.y());
    return pixel;
  }
  /// As above, written to u and v.
  void project(const Eigen::Vector3d& p_camera, double& u, double& v) const;

  /// Whether the camera-frame point p [m] projects into the image: p.z > 0, its pixel coordinates
  /// lie in [-0.5, width - 0.5) x [-0.5, height - 0.5), and it lies on the ray of those
  /// coordinates. The last condition excludes points that the distortion folds into the image.
  /// Ignores occlusion and the sensor's range limits.
  [[nodiscard]] bool sees(const Eigen::Vector3d& p_camera) const;

  /// ray() of every pixel centre: directions (x, y, 1) in the camera frame, row-major, width *
  /// height entries. Cost: one ray() per pixel.
  [[nodiscard]] std::vector<Eigen::Vector3d> ray_table() const;

  /// Solid angle of every pixel [sr], row-major; 0 for a pixel without a ray. For a ray at angle α
  /// to the optical axis it is cos³α / (fx fy). With distortion it is cos³α |∂(x, y) / ∂(u, v)|,
  /// where the derivatives are differences between neighbouring pixels. `rays` must be the result
  /// of ray_table(). Throws Error(invalid_argument) for a wrong number of rays.
  [[nodiscard]] std::vector<double> solid_angles(std::span<const Eigen::Vector3d> rays) const;

  bool operator==(const PinholeCamera&) const = default;
};

}  // namespace viewgain
