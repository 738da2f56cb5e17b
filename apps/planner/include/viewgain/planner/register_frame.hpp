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

/// By how much reported poses may be off unless one says otherwise: 5 mm, half a degree.
inline constexpr PoseSigma kUsualPoseSigma{0.005, 0.0087};

/// What came of a registration.
enum class RegistrationStatus : std::uint8_t {
  registered,
  too_little_overlap,  ///< the others say too little of what the frame shows; the pose stays
  refused,             ///< frame and others contradict each other under every likely pose
};
/// Its name, for people and files; "unknown" for a number that is none of them: never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view registration_status_name(RegistrationStatus status);

/// A motion of the camera that changes nothing in how frame and others fit, one sigma of the report
/// long: along a plane, round a sphere's centre.
struct VIEWGAIN_EXPORT FreeDirection {
  Eigen::Vector3d translation;  ///< of the camera's centre, world axes [m]
  Eigen::Vector3d rotation;     ///< about the camera's centre, world axes [rad]
};

/// What became of a frame, held against others: frames, or a map.
struct VIEWGAIN_EXPORT FrameRegistration {
  /// Whether the correction was found, and why not.
  RegistrationStatus status = RegistrationStatus::too_little_overlap;
  std::string reason;   ///< of the status, for people; empty if registered
  Pose T_world_camera;  ///< corrected if registered, else as reported, made rigid
  /// The correction, of a frame that is not registered the one that was tried last: the way of the
  /// camera's centre [m] and the angle [rad].
  double translation = 0;
  double rotation = 0;  ///< of the correction [rad]
  /// RMS distance of readings from the others' surface, along its normal [m]: of the pairs at the
  /// reported and at the corrected pose. 0 without pairs.
  double residual_before = 0;
  double residual_after = 0;  ///< after the correction [m]
  std::size_t readings = 0;   ///< that were looked at: in the workspace, with a normal
  std::size_t pairs = 0;      ///< of these, that lie on surface that others have in the end
  double overlap = 0;         ///< share pairs / readings
  /// The larger share of the frame's readings in space that others know to be free, and of the
  /// others' surface that the frame looks past.
  double contradiction = 0;
  int iterations = 0;  ///< of the last alignment
  /// Of the pose given report and frames, row by row: translation of the camera's centre [m], then
  /// rotation about it [rad], world axes. Relative to the others: how far these are off as a whole
  /// is not in it. That of the report unless registered; zero of a first frame, which says where
  /// the world is.
  std::array<double, 36> covariance{};
  /// What the covariance leaves, for the readings of the frame: the roots of its mean variances of
  /// translation [m] and rotation [rad].
  [[nodiscard]] PoseSigma pose_sigma() const;
  /// The least information of the others along any motion, in units of the report's: under 1 the
  /// report knows that motion better.
  double smallest_information = 0;
  /// In any order: along these the pose stays as reported.
  std::vector<FreeDirection> free_directions{};
};

}  // namespace viewgain
