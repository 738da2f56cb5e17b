// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/range_calibration.hpp"

namespace viewgain {

/// Uncertainty of the poses of frames: standard deviations per axis, about the camera centre. A
/// value type.
struct VIEWGAIN_EXPORT PoseSigma {
  double translation = 0;  ///< of the camera centre [m]
  double rotation = 0;     ///< of each component of the rotation vector [rad]
  bool operator==(const PoseSigma&) const = default;
};

/// A depth camera: intrinsics, range limits along the ray, and noise; defaults to the preset
/// sr4000. A value type. Members check nothing unless stated otherwise.
struct VIEWGAIN_EXPORT Sensor {
  /// Meaning of the value 65535 in a depth image.
  enum class OutOfRange : std::uint8_t {
    carve,    ///< free up to max_range
    invalid,  ///< no reading
  };

  std::string name = "sr4000";  ///< name of the preset or file, for reports
  PinholeCamera camera{176, 144, 220.0, 231.2, 87.5, 71.5, {}};  ///< intrinsics and distortion
  double min_range = 0.2;                                        ///< along the ray [m]
  double max_range = 5.0;                                        ///< along the ray [m]
  double working_distance = 0.4;                                 ///< intended distance [m]
  NoiseModel noise;                                              ///< noise model of readings
  std::optional<Pose>
      T_flange_camera;  ///< pose of the camera in the frame of the robot's flange, if known
  /// Width, height and depth of the housing along x, y, z of the flange frame [m], if known.
  /// Otherwise FeasibilityConfig::Body (raycast/feasibility.hpp) uses the SR4000's.
  std::optional<std::array<double, 3>> body_size{};
  /// Systematic range error, which load_frame() subtracts; empty: unknown. Correct frames from
  /// other sources with RangeCalibration::correct().
  RangeCalibration range_calibration{};

  PoseSigma pose_sigma{};  ///< zero: poses are exact
  /// Standard deviation of a scale error: a relative error that all ranges share, so that more
  /// readings do not reduce it. 0: none. It enters the covariances of points
  /// (FusedPointsConfig::scale_sigma), but not sigmas().
  double scale_sigma = 0;
  /// Meaning of 65535 in its depth images if the folder does not state it; empty: see
  /// FrameSequence.
  std::optional<OutOfRange> out_of_range{};

  /// Standard deviations of a reading (one measured depth) at range t [m] with the cosine of
  /// incidence cos_incidence, camera frame; see sigmas() in noise.hpp.
  [[nodiscard]] MeasurementSigmas noise_sigmas(double t, double cos_incidence = 1.0) const {
    return viewgain::sigmas(noise, t, camera.fx, cos_incidence);
  }
  /// Standard deviations of a reading in the world, including the pose uncertainty. The covariance
  /// is C + σ_t² I + σ_r² t² (I - d dᵀ), where C is that of the sensor and d the direction of the
  /// ray. Map and gains treat readings as independent. In fact all readings of a frame share the
  /// pose error, so a voxel with many readings appears more certain than it is.
  [[nodiscard]] MeasurementSigmas sigmas(double t, double cos_incidence = 1.0) const {
    const MeasurementSigmas own = noise_sigmas(t, cos_incidence);
    if (pose_sigma == PoseSigma{}) return own;
    const double turned = pose_sigma.rotation * t;
    return {std::hypot(own.axial, pose_sigma.translation),
            std::hypot(own.lateral, pose_sigma.translation, turned)};
  }

  /// Throws Error(invalid_argument) naming the field unless: the camera passes
  /// PinholeCamera::validate(); 0 <= min_range < max_range; working_distance > 0 lies within; noise
  /// parameters are positive and finite, where modulation frequency, least amplitude and single
  /// terms of a sum may be 0; T_flange_camera is rigid (1e-3); body_size is positive; pose_sigma
  /// and scale_sigma are not negative; and range_calibration passes its validate(), with positive
  /// measured and corrected ranges.
  void validate() const;

  bool operator==(const Sensor&) const = default;
};

/// Names of the presets: sr4000, azure_kinect_nfov, kinect_v1, d435, and laser_line, a scanner of
/// one line per pose (640x1 px, sigmas 0.2 mm, 0.1-1.0 m). Presets of real cameras include the size
/// of the housing; that of kinect_v1 is approximate and excludes the foot.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& sensor_preset_names();

/// Returns a preset. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Sensor sensor_preset(std::string_view name);

/// TOML description of a sensor; apps/docs/reference/formats.md documents the layout. Read back
/// with read_sensor_toml() of viewgain::formats, it gives an equal sensor. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT std::string sensor_toml(const Sensor& sensor);

/// Value of `model` in such a file: shot, structured_light, stereo, quadratic or constant. Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view noise_model_name(const NoiseModel& noise);

/// Default sigma_0 [m] of an unknown voxel with edge voxel_size [m]: max(voxel / 2, 2 sigma_ax at
/// the working distance, frontal). Throws Error(invalid_argument) unless voxel_size is positive and
/// finite.
[[nodiscard]] VIEWGAIN_EXPORT double default_prior_sigma(double voxel_size, const Sensor& sensor);

}  // namespace viewgain
