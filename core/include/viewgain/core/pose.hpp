// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Rigid transform, for a camera T_world_camera: maps points of the camera's optical frame (x
/// right, y down, z forward) to the world. Twelve doubles, the rows of [R | t] with t in [m]. Size
/// and alignment do not depend on compiler flags, so it may cross a library boundary, which
/// Eigen::Isometry3d may not (its alignment follows -march). A value type. Members check nothing
/// and never throw.
struct VIEWGAIN_EXPORT Pose {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< [R | t] by rows, t in [m]

  /// The identity.
  Pose() = default;

  /// From Eigen; inline on purpose, so that the caller's alignment rules apply to the argument.
  Pose(const Eigen::Isometry3d& T) {  // NOLINT(google-explicit-constructor): vectors convert
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) m[static_cast<std::size_t>(4 * r + c)] = T.matrix()(r, c);
    }
  }

  /// From a rotation matrix and a translation [m]; not checked.
  Pose(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) m[static_cast<std::size_t>(4 * r + c)] = R(r, c);
      m[static_cast<std::size_t>(4 * r + 3)] = t[r];
    }
  }

  /// As Eigen's transform.
  [[nodiscard]] Eigen::Isometry3d isometry() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation();
    T.translation() = translation();
    return T;
  }

  /// R, a copy.
  [[nodiscard]] Eigen::Matrix3d rotation() const {
    return (Eigen::Matrix3d() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]).finished();
  }

  /// t, the camera's centre in the world [m].
  [[nodiscard]] Eigen::Vector3d translation() const { return {m[3], m[7], m[11]}; }

  /// R p + t: a point `p` [m] of the camera's frame in the world [m].
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const {
    return rotation() * p + translation();
  }

  /// T_a_b * T_b_c = T_a_c.
  [[nodiscard]] Pose operator*(const Pose& other) const {
    return {rotation() * other.rotation(), rotation() * other.translation() + translation()};
  }

  /// Inverse of a rigid transform; the rotation must be orthonormal.
  [[nodiscard]] Pose inverse() const {
    const Eigen::Matrix3d R_inverse = rotation().transpose();
    return {R_inverse, -(R_inverse * translation())};
  }

  bool operator==(const Pose&) const = default;
};
static_assert(sizeof(Pose) == 96 && alignof(Pose) == 8);

/// How far the rotation is from orthonormal and right-handed: the largest absolute entry of RᵀR - I
/// [1], infinity if any of the twelve numbers is not finite or det R <= 0. In any frame.
[[nodiscard]] VIEWGAIN_EXPORT double orthonormality_error(const Pose& pose);

/// The nearest rotation (polar decomposition by SVD) with the same translation. Deterministic. A
/// pose with a number that is not finite comes back as it is: never throws. In the same frame.
[[nodiscard]] VIEWGAIN_EXPORT Pose orthonormalized(const Pose& pose);

/// The pose that all who ask for a rigid transform take a given one for: itself if
/// orthonormality_error() is at most 1e-9, orthonormalized() if it is at most kMaxPoseError, else
/// none. Never throws. In the same frame.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Pose> rigid_pose(const Pose& pose);
inline constexpr double kMaxPoseError = 1e-3;  ///< [1]

/// T_world_camera of a camera at `eye` [m] whose optical axis passes through `target` [m] and whose
/// image-up direction (minus y) is as near to `up`, of whatever unit, as it can be. Where the view
/// direction is parallel to `up`, +x of the world (then +y) takes its place. Throws
/// Error(invalid_argument) if eye equals target, if up is zero, or if a number is not finite.
/// Orthonormal to 1e-15.
[[nodiscard]] VIEWGAIN_EXPORT Pose look_at(const Eigen::Vector3d& eye,
                                           const Eigen::Vector3d& target,
                                           const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

}  // namespace viewgain
