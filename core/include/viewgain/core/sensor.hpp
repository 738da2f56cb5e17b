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

/// How far the poses that frames come with may be off: standard deviations, the same in each axis,
/// about the camera's centre. A value type.
struct VIEWGAIN_EXPORT PoseSigma {
  double translation = 0;  ///< of the camera's centre [m]
  double rotation = 0;     ///< of each component of the rotation vector [rad]
  bool operator==(const PoseSigma&) const = default;
};

/// A depth camera: intrinsics, range limits along the ray, noise; by default the preset sr4000. A
/// value type; unless they say otherwise members check nothing.
struct VIEWGAIN_EXPORT Sensor {
  /// What the value 65535 of a depth image says.
  enum class OutOfRange : std::uint8_t {
    carve,    ///< nothing up to max_range
    invalid,  ///< no reading
  };

  std::string name = "sr4000";  ///< preset's or file's name, for reports
  PinholeCamera camera{176, 144, 220.0, 231.2, 87.5, 71.5, {}};  ///< intrinsics, lens
  double min_range = 0.2;                                        ///< along the ray [m]
  double max_range = 5.0;                                        ///< along the ray [m]
  double working_distance = 0.4;        ///< where it is meant to be used [m]
  NoiseModel noise;                     ///< how readings scatter
  std::optional<Pose> T_flange_camera;  ///< mounting on the robot's flange, if known
  /// Width, height, depth of the housing along x, y, z of the flange's frame [m], if known; see
  /// FeasibilityConfig::Body in raycast/feasibility.hpp, which takes the SR4000's otherwise.
  std::optional<std::array<double, 3>> body_size{};
  /// Its systematic error, which load_frame() takes away; without a table none is known. Camera
  /// frames from elsewhere are corrected by RangeCalibration::correct().
  RangeCalibration range_calibration{};

  PoseSigma pose_sigma{};  ///< zero: poses are exact
  /// Of the factor that all ranges are off by, less 1; zero: none. All readings share it, so that
  /// no number of them makes a point surer of it: it is in points' covariances
  /// (FusedPointsConfig::scale_sigma), and in no reading's sigmas().
  double scale_sigma = 0;
  /// In its depth images, where the folder does not say it; nothing: see FrameSequence.
  std::optional<OutOfRange> out_of_range{};

  /// Standard deviations of a reading at range t [m], whose cosine of incidence is cos_incidence,
  /// in the camera's frame; see sigmas() in noise.hpp.
  [[nodiscard]] MeasurementSigmas noise_sigmas(double t, double cos_incidence = 1.0) const {
    return viewgain::sigmas(noise, t, camera.fx, cos_incidence);
  }
  /// The same in the world, where the pose's error is added: C + J Σ Jᵀ, for a reading along the
  /// direction d is C + σ_t² I + σ_r² t² (I - d dᵀ). That error is one for all readings of a frame;
  /// map and gains take readings for independent, so that what many of them say of a voxel is
  /// surer than it should be.
  [[nodiscard]] MeasurementSigmas sigmas(double t, double cos_incidence = 1.0) const {
    const MeasurementSigmas own = noise_sigmas(t, cos_incidence);
    if (pose_sigma == PoseSigma{}) return own;
    const double turned = pose_sigma.rotation * t;
    return {std::hypot(own.axial, pose_sigma.translation),
            std::hypot(own.lateral, pose_sigma.translation, turned)};
  }

  /// Throws Error(invalid_argument), naming the field: camera as in PinholeCamera::validate(),
  /// 0 <= min_range < max_range, working_distance > 0 and within them, all noise parameters
  /// positive and finite (what only adds to a sigma may be 0 as long as the sigma along the ray is
  /// positive within the ranges; modulation frequency and least amplitude, too), T_flange_camera
  /// rigid (1e-3), body_size positive and finite, pose_sigma and scale_sigma not negative
  /// and finite, range_calibration as in RangeCalibration::validate() with ranges that are
  /// positive, measured and corrected.
  void validate() const;

  bool operator==(const Sensor&) const = default;
};

/// The presets: sr4000, azure_kinect_nfov, kinect_v1, d435; and laser_line,
/// a scanner of one line a pose (640x1 px, 0.2 mm in each direction, 0.1-1.0 m). Those of a maker
/// have the size of his housing (kinect_v1: about, without its foot), the SR4000 as
/// FeasibilityConfig::Body has it.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& sensor_preset_names();

/// Throws Error(invalid_argument) that lists the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Sensor sensor_preset(std::string_view name);

/// The TOML description of a sensor; apps/docs/reference/formats.md shows the layout. Reading what
/// was written (read_sensor_toml() of viewgain::formats) gives an equal sensor. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT std::string sensor_toml(const Sensor& sensor);

/// What `model` is in such a file: shot, structured_light, stereo, quadratic, constant. Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view noise_model_name(const NoiseModel& noise);

/// sigma_0 [m] of an unknown voxel of the edge voxel_size [m] when the map does not say: max(voxel
/// / 2, 2 sigma_ax at the working distance, frontal). Throws Error(invalid_argument) unless
/// voxel_size is positive, finite.
[[nodiscard]] VIEWGAIN_EXPORT double default_prior_sigma(double voxel_size, const Sensor& sensor);

}  // namespace viewgain
