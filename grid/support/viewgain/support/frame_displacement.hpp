// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"

namespace viewgain {

/// Tangent plane of the surface in a square of pixels, at its centre, as the vector m [1/m] with m
/// · p = 1 for its points p in the camera frame. Empty if depths are missing or deviate from a
/// plane by more than `sigma` [m], the noise of a depth, explains, and at the image edge. `rays`:
/// the camera's ray_table().
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Eigen::Vector3d> plane_at(
    const DepthFrame& frame, const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& rays,
    std::size_t u, std::size_t v, double sigma);

/// Displacement of a frame's surface from readings of others: the small rigid motion that aligns
/// them (point to plane; Chen and Medioni 1992).
class VIEWGAIN_EXPORT DisplacementFit {
 public:
  /// A reading `p` [m] at this signed distance [m] behind the plane with this unit normal, all in
  /// the camera frame. `expected` [m]: its uncertainty.
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double distance,
           double expected);

  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  /// Whether there are at least 60 readings, as displacement() and expected() require.
  [[nodiscard]] bool tells() const;
  /// RMS of the motion along the normals [m], minus the share of noise.
  [[nodiscard]] double displacement() const;
  /// Median of the expected distances [m].
  [[nodiscard]] double expected() const;

 private:
  struct Pair {
    Eigen::Matrix<double, 6, 1>
        by_motion;  ///< derivative of the distance by rotation [m/rad] and translation
    double distance = 0, expected = 0;  ///< [m]
  };
  std::vector<Pair> pairs_;
};

}  // namespace viewgain
