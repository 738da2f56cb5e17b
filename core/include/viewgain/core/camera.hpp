// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Pinhole camera with OpenCV's distortion model, optical frame: x right, y down, z forward. Pixel
/// (0,0) has its centre at (0,0), as in OpenCV. A value type. Unless they say otherwise members
/// check nothing: the camera must be one that validate() takes.
struct VIEWGAIN_EXPORT PinholeCamera {
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  double fx = 0, fy = 0;               ///< focal lengths [px]
  double cx = 0, cy = 0;               ///< principal point [px]
  std::array<double, 5> distortion{};  ///< coefficients k1 k2 p1 p2 k3

  /// Does any of the coefficients differ from 0?
  [[nodiscard]] bool has_distortion() const { return distortion != std::array<double, 5>{}; }

  /// Throws Error(invalid_argument), naming the field, unless sizes are in 1..16384 and make at
  /// most 2^24 pixels (a table of rays takes 24 bytes per pixel), focal lengths are positive and
  /// all numbers are finite.
  void validate() const;

  /// Direction (x, y, 1) in the camera frame of the ray through pixel coordinates (u, v) [px],
  /// distortion undone (fixed-point then Newton to 1e-12; NaN where the model has no solution that
  /// is joined to the optical axis without a fold). Exact, and cheap, without distortion.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const;

  /// Pixel coordinates (u, v) [px] of the camera-frame point p [m], distortion applied; NaN unless
  /// p.z > 0. As in OpenCV a strong distortion may fold a point far outside the view back into it.
  /// Inline on purpose: Eigen aligns a Vector2d or not by the caller's compiler flags.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    Eigen::Vector2d pixel;
    project(p_camera, pixel.x(), pixel.y());
    return pixel;
  }
  /// The same into u and v.
  void project(const Eigen::Vector3d& p_camera, double& u, double& v) const;

  /// Whether the camera-frame point p [m] is in the image: p.z > 0, its pixel coordinates are in
  /// [-0.5, width - 0.5) x [-0.5, height - 0.5), and it lies on the ray of those. With distortion
  /// that last leaves out what is folded into the image from far outside the view. What is in
  /// between, and the sensor's range limits, are not looked at.
  [[nodiscard]] bool sees(const Eigen::Vector3d& p_camera) const;

  /// ray() of every pixel centre, row by row: directions (x, y, 1) [1] in the camera frame, width *
  /// height of them. Costs a ray() each.
  [[nodiscard]] std::vector<Eigen::Vector3d> ray_table() const;

  /// The solid angle of every pixel [sr], row by row: cos³α / (fx fy) for a ray at α from the
  /// optical axis, and with a lens cos³α |∂(x, y) / ∂(u, v)|; 0 where a pixel has no ray. The
  /// derivatives are central differences between pixels, at the image's edge and beside pixels
  /// without a ray one-sided. `rays` [1] is ray_table(), which takes longer than this. Throws
  /// Error(invalid_argument) for another number of rays.
  [[nodiscard]] std::vector<double> solid_angles(std::span<const Eigen::Vector3d> rays) const;

  bool operator==(const PinholeCamera&) const = default;
};

}  // namespace viewgain
