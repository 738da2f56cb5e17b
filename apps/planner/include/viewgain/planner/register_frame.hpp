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
  too_little_overlap,  ///< the others show too little of the frame's surface; the pose stays
  refused,             ///< the frame contradicts the others under every likely pose
};
/// Name for people and files; "unknown" for an invalid value. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view registration_status_name(RegistrationStatus status);

/// A motion of the camera that does not change the fit, one sigma of the report long: along a
/// plane, or around a sphere's centre.
struct VIEWGAIN_EXPORT FreeDirection {
  Eigen::Vector3d translation;  ///< of the camera's centre, world axes [m]
  Eigen::Vector3d rotation;     ///< about the camera's centre, world axes [rad]
};

/// Registration of a frame against other frames or a map.
struct VIEWGAIN_EXPORT FrameRegistration {
  /// Whether a correction was found, and why not.
  RegistrationStatus status = RegistrationStatus::too_little_overlap;
  std::string reason;   ///< reason of the status, for people; empty if registered
  Pose T_world_camera;  ///< corrected if registered, otherwise as reported, made rigid
  /// Size of the correction: displacement of the camera centre [m] and angle [rad]. For a frame
  /// that is not registered, of the last attempt.
  double translation = 0;
  double rotation = 0;  ///< angle of the correction [rad]
  /// RMS distance of readings from the others' surface along its normal [m], over the pairs at the
  /// reported and at the corrected pose. 0 without pairs.
  double residual_before = 0;
  double residual_after = 0;  ///< after the correction [m]
  std::size_t readings = 0;   ///< evaluated readings: in the workspace, with a normal
  std::size_t pairs = 0;      ///< of these, those on surface of the others in the end
  double overlap = 0;         ///< share pairs / readings
  /// The larger of two shares: the frame's readings in free space of the others, and the others'
  /// surface that the frame sees past.
  double contradiction = 0;
  int iterations = 0;  ///< iterations of the last alignment
  /// Covariance of the pose given report and frames, row-major: translation of the camera centre
  /// [m], then rotation about it [rad], world axes. Relative to the others, whose common error is
  /// not included. The report's covariance unless registered; zero for a first frame, which defines
  /// the world.
  std::array<double, 36> covariance{};
  /// Uncertainty that the covariance leaves, for the frame's readings: roots of the mean variances
  /// of translation [m] and rotation [rad].
  [[nodiscard]] PoseSigma pose_sigma() const;
  /// Smallest information of the others over all motions, relative to the report's; below 1 the
  /// report is more accurate for that motion.
  double smallest_information = 0;
  /// Motions along which the pose stays as reported.
  std::vector<FreeDirection> free_directions{};
};

}  // namespace viewgain
