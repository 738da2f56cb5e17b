// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Rigid transform. The pose of a camera is T_world_camera, which maps points of the camera frame
/// (x right, y down, z forward) to the world frame. A pose has twelve doubles, the rows of [R | t],
/// with t in metres. Its size and alignment do not depend on compiler flags, so it can cross
/// library boundaries; Eigen::Isometry3d cannot. A value type. Members do not check their arguments
/// and never throw.
struct VIEWGAIN_EXPORT Pose {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< [R | t], row-major; t in [m]

  /// The identity.
  Pose() = default;

  /// From an Eigen transform. Inline, because the argument's alignment depends on the caller's
  /// compiler flags.
  Pose(const Eigen::Isometry3d& T) {  // NOLINT(google-explicit-constructor): vectors convert
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) m[static_cast<std::size_t>(4 * r + c)] = T.matrix()(r, c);
    }
  }

  /// From a rotation matrix, which is not checked, and a translation [m].
  Pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) m[static_cast<std::size_t>(4 * r + c)] = R(r, c);
      m[static_cast<std::size_t>(4 * r + 3)] = t[r];
    }
  }

  /// Converts to an Eigen transform.
  [[nodiscard]] Eigen::Isometry3d isometry() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation();
    T.translation() = translation();
    return T;
  }

  /// The rotation R, as a copy.
  [[nodiscard]] Eigen::Matrix3d rotation() const {
    return (Eigen::Matrix3d() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]).finished();
  }

  /// The translation t, the camera centre in the world [m].
  [[nodiscard]] Eigen::Vector3d translation() const { return {m[3], m[7], m[11]}; }

  /// R p + t: maps the camera-frame point `p` [m] to the world [m].
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const {
    return rotation() * p + translation();
  }

  /// Composition: T_a_b * T_b_c = T_a_c.
  [[nodiscard]] Pose operator*(const Pose& other) const {
    return {rotation() * other.rotation(), rotation() * other.translation() + translation()};
  }

  /// The inverse transform. The rotation must be orthonormal.
  [[nodiscard]] Pose inverse() const {
    const Eigen::Matrix3d R_inverse = rotation().transpose();
    return {R_inverse, -(R_inverse * translation())};
  }

  bool operator==(const Pose&) const = default;
};
static_assert(sizeof(Pose) == 96 && alignof(Pose) == 8);

/// How far R is from a rotation matrix: the largest absolute entry of RᵀR - I, dimensionless.
/// Infinity if any number is not finite or det R <= 0. "A pose that is rigid within 1e-3" means a
/// pose for which this error is at most 1e-3.
[[nodiscard]] VIEWGAIN_EXPORT double orthonormality_error(const Pose& pose);

/// The pose with the nearest rotation matrix (polar decomposition by SVD) and the same translation.
/// If a number is not finite, returns the pose unchanged. Deterministic. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT Pose orthonormalized(const Pose& pose);

/// The rigid transform that the library uses for a pose. If orthonormality_error() is at most 1e-9,
/// it is the pose itself. If the error is larger, but at most kMaxPoseError, it is
/// orthonormalized(). Otherwise the pose is invalid, and the result is empty. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Pose> rigid_pose(const Pose& pose);
inline constexpr double kMaxPoseError = 1e-3;  ///< largest orthonormality_error() that is repaired

/// T_world_camera of a camera at `eye` [m] whose optical axis passes through `target` [m]. The
/// image's up direction (minus y) is as close as possible to `up`, a vector of any length. If the
/// view direction is parallel to `up`, +x of the world replaces `up`; if it is parallel to +x too,
/// +y does. The rotation is orthonormal to 1e-15. Throws Error(invalid_argument) if eye equals
/// target, up is zero, or a number is not finite.
[[nodiscard]] VIEWGAIN_EXPORT Pose look_at(const Eigen::Vector3d& eye,
                                           const Eigen::Vector3d& target,
                                           const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

}  // namespace viewgain
