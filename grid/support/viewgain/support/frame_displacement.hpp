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

/// The tangent plane of what a square of pixels sees, at its middle, as the vector m [1/m] with
/// m · p = 1 for its points p in the camera frame. Nothing where depths are missing or are off a
/// plane by more than `sigma` [m], noise of a depth, explains, and at the image's edge. `rays`: the
/// camera's ray_table().
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Eigen::Vector3d> plane_at(
    const DepthFrame& frame, const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& rays,
    std::size_t u, std::size_t v, double sigma);

/// How far a frame's surface lies from readings of others, by the small rigid motion that brings
/// them together (point to plane; Chen and Medioni 1992).
class VIEWGAIN_EXPORT DisplacementFit {
 public:
  /// A reading `p` [m] at this signed distance [m] behind the plane with this unit normal, all in
  /// the frame's camera frame. `expected` [m]: what the distance may be off by.
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double distance,
           double expected);

  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  /// Are there at least 60 readings, as displacement() and expected() require?
  [[nodiscard]] bool tells() const;
  /// RMS of the motion along the normals [m], what noise adds taken off.
  [[nodiscard]] double displacement() const;
  /// The median of what was expected [m].
  [[nodiscard]] double expected() const;

 private:
  struct Pair {
    Eigen::Matrix<double, 6, 1> by_motion;  ///< distance by rotation [m/rad] and translation
    double distance = 0, expected = 0;      ///< [m]
  };
  std::vector<Pair> pairs_;
};

}  // namespace viewgain
