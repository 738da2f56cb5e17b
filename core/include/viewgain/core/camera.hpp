// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Pinhole camera with OpenCV's distortion model. The camera frame has x right, y down and z
/// forward. As in OpenCV, the centre of the first pixel has the pixel coordinates (0, 0). A value
/// type. Members require a camera that passes validate(). They do not check their arguments unless
/// stated otherwise.
struct VIEWGAIN_EXPORT PinholeCamera {
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  double fx = 0, fy = 0;               ///< focal lengths [px]
  double cx = 0, cy = 0;               ///< principal point [px]
  std::array<double, 5> distortion{};  ///< coefficients k1 k2 p1 p2 k3

  /// Whether any coefficient differs from 0.
  [[nodiscard]] bool has_distortion() const { return distortion != std::array<double, 5>{}; }

  /// Throws Error(invalid_argument), naming the field, unless:
  /// - width and height are in 1..16384, and there are at most 2^24 pixels
  /// - the focal lengths are positive, and all numbers are finite
  void validate() const;

  /// Direction (x, y, 1), in the camera frame, of the ray through the pixel coordinates (u, v)
  /// [px]. Inverts the distortion by iteration; x and y are accurate to 1e-12. Without distortion
  /// the result is exact and cheap. NaN if the pixel has no ray. This happens if the distortion
  /// model is not invertible between the optical axis and this pixel.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const;

  /// Pixel coordinates (u, v) [px] of the camera-frame point p [m], with distortion. NaN unless p.z
  /// > 0. As in OpenCV, strong distortion can map a point far outside the view into the image.
  /// Inline, because the alignment of an Eigen Vector2d depends on the caller's compiler flags.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    Eigen::Vector2d pixel;
    project(p_camera, pixel.x(), pixel.y());
    return pixel;
  }
  /// As above, written to u and v.
  void project(const Eigen::Vector3d& p_camera, double& u, double& v) const;

  /// Whether the camera-frame point p [m] projects into the image. This requires that p.z > 0, that
  /// its pixel coordinates lie in [-0.5, width - 0.5) x [-0.5, height - 0.5), and that it lies on
  /// the ray of these coordinates. The last condition excludes points that only strong distortion
  /// maps into the image. Ignores occlusion and the sensor's range limits.
  [[nodiscard]] bool sees(const Eigen::Vector3d& p_camera) const;

  /// ray() of every pixel centre: width * height directions (x, y, 1) in the camera frame,
  /// row-major. Cost: one ray() and 24 bytes per pixel.
  [[nodiscard]] std::vector<Eigen::Vector3d> ray_table() const;

  /// Solid angle of every pixel [sr], row-major; 0 for a pixel without a ray. `rays` must be the
  /// result of ray_table(). The solid angle is cos³α |∂(x, y) / ∂(u, v)|, where α is the angle
  /// between the pixel's ray and the optical axis. The derivatives are differences between the rays
  /// of neighbouring pixels; without distortion, this is cos³α / (fx fy). Throws
  /// Error(invalid_argument) for a wrong number of rays.
  [[nodiscard]] std::vector<double> solid_angles(std::span<const Eigen::Vector3d> rays) const;

  bool operator==(const PinholeCamera&) const = default;
};

}  // namespace viewgain
