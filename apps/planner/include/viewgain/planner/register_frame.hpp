// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// Default uncertainty of reported poses: 5 mm, half a degree.
inline constexpr PoseSigma kUsualPoseSigma{0.005, 0.0087};

/// Result of a registration.
enum class RegistrationStatus : std::uint8_t {
  registered,
  too_little_overlap,  ///< the other frames show too little of this frame's surface; the pose stays
                       ///< as reported
  refused,             ///< the frame contradicts the other frames under every likely pose
};
/// Name for messages and files; "unknown" for an invalid value. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view registration_status_name(RegistrationStatus status);

/// A motion of the camera that does not change how well the frame fits, such as along a plane or
/// around a sphere's centre. Its length is one standard deviation of the reported pose.
struct VIEWGAIN_EXPORT FreeDirection {
  Eigen::Vector3d translation;  ///< of the camera's centre, world axes [m]
  Eigen::Vector3d rotation;     ///< about the camera's centre, world axes [rad]
};

/// Result of registering a frame with other frames or a map ("the others" below).
struct VIEWGAIN_EXPORT FrameRegistration {
  /// Whether a correction was found, or why not.
  RegistrationStatus status = RegistrationStatus::too_little_overlap;
  std::string reason;  ///< reason of the status, for people; empty if registered
  /// The corrected pose. If the frame is not registered, this is the reported pose,
  /// orthonormalised.
  Pose T_world_camera;
  /// Displacement of the camera centre by the correction [m]. If the frame is not registered, this
  /// and `rotation` describe the last attempt.
  double translation = 0;
  double rotation = 0;  ///< angle of the correction [rad]
  /// RMS distance of this frame's readings (measured depths) from the others' surface, along the
  /// surface normal, at the reported pose [m]. 0 without pairs.
  double residual_before = 0;
  double residual_after = 0;  ///< the same at the corrected pose [m]
  std::size_t readings = 0;   ///< readings used: those in the workspace with a surface normal
  std::size_t pairs = 0;      ///< number of these that lie on the others' surface after the
                              ///< alignment
  double overlap = 0;         ///< pairs / readings
  /// The larger of two fractions. One is the fraction of the frame's readings that lie in free
  /// space of the others. The other is the fraction of the others' surface that the frame sees
  /// past.
  double contradiction = 0;
  int iterations = 0;  ///< iterations of the last alignment
  /// Covariance of the pose relative to the others, row-major: translation of the camera centre
  /// [m], then rotation about it [rad], world axes. An error that all frames share is not included.
  /// If the frame is not registered, this is the covariance of the reported pose. For the first
  /// frame, which defines the world, it is zero.
  std::array<double, 36> covariance{};
  /// Pose uncertainty from the covariance, for integrating the frame: roots of the mean variances
  /// of translation [m] and rotation [rad].
  [[nodiscard]] PoseSigma pose_sigma() const;
  /// How well the others determine the pose. For each motion, the information from the others is
  /// divided by that of the reported pose; this is the smallest of these ratios. If it is below 1,
  /// the reported pose is more accurate along that motion.
  double smallest_information = 0;
  /// Motions along which the pose stays as reported.
  std::vector<FreeDirection> free_directions{};
};

}  // namespace viewgain
