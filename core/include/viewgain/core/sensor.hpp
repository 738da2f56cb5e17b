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

/// Uncertainty of the poses of frames, as standard deviations per axis. The rotation is about the
/// camera centre. A value type.
struct VIEWGAIN_EXPORT PoseSigma {
  double translation = 0;  ///< of each coordinate of the camera centre [m]
  double rotation = 0;     ///< of each component of the rotation vector [rad]
  bool operator==(const PoseSigma&) const = default;
};

/// A depth camera: intrinsics, range limits and noise. A reading is one measured depth. A default
/// Sensor is the preset sr4000. A value type. Members do not check their arguments unless stated
/// otherwise.
struct VIEWGAIN_EXPORT Sensor {
  /// Meaning of the value 65535 in a depth image.
  enum class OutOfRange : std::uint8_t {
    carve,    ///< the ray is free up to max_range
    invalid,  ///< the pixel measured nothing
  };

  std::string name = "sr4000";  ///< name of the preset or of the file
  PinholeCamera camera{176, 144, 220.0, 231.2, 87.5, 71.5, {}};  ///< intrinsics and distortion
  double min_range = 0.2;                                        ///< along the ray [m]
  double max_range = 5.0;                                        ///< along the ray [m]
  double working_distance = 0.4;  ///< intended distance from the surface [m]
  NoiseModel noise;               ///< noise model of readings
  std::optional<Pose>
      T_flange_camera;  ///< pose of the camera in the frame of the robot's flange, if known
  /// Width, height and depth of the housing along x, y and z of the flange frame [m], if known. If
  /// unknown, feasibility_of() (raycast/feasibility.hpp) uses the size of the SR4000.
  std::optional<std::array<double, 3>> body_size{};
  /// Systematic range error; empty: unknown. load_frame() of viewgain::formats corrects it. Correct
  /// frames from other sources with RangeCalibration::correct().
  RangeCalibration range_calibration{};

  PoseSigma pose_sigma{};  ///< uncertainty of the poses of frames; 0: exact
  /// Standard deviation of a relative error that all ranges share, so that more readings do not
  /// reduce it; 0: none. It affects the covariances of points (FusedPointsConfig::scale_sigma), but
  /// not sigmas().
  double scale_sigma = 0;
  /// Meaning of 65535 in depth images, used if their folder does not state it. Empty: FrameSequence
  /// (viewgain::formats) chooses by the layout of the folder.
  std::optional<OutOfRange> out_of_range{};

  /// Standard deviations of a reading, without the pose uncertainty. `t` is the range [m].
  /// `cos_incidence` is the cosine of the angle between surface normal and ray.
  [[nodiscard]] MeasurementSigmas noise_sigmas(double t, double cos_incidence = 1.0) const {
    return viewgain::sigmas(noise, t, camera.fx, cos_incidence);
  }
  /// As above, including the pose uncertainty. The covariance is C + σ_t² I + σ_r² t² (I - d dᵀ),
  /// where C is the covariance from noise_sigmas(), d the direction of the ray, and σ_t and σ_r are
  /// the members of pose_sigma. All readings of a frame share one pose error, but map and gains
  /// treat readings as independent. A voxel with many readings therefore appears more certain than
  /// it is.
  [[nodiscard]] MeasurementSigmas sigmas(double t, double cos_incidence = 1.0) const {
    const MeasurementSigmas own = noise_sigmas(t, cos_incidence);
    if (pose_sigma == PoseSigma{}) return own;
    const double turned = pose_sigma.rotation * t;
    return {std::hypot(own.axial, pose_sigma.translation),
            std::hypot(own.lateral, pose_sigma.translation, turned)};
  }

  /// Throws Error(invalid_argument), naming the field, unless:
  /// - the camera and range_calibration pass their validate(), and all measured and corrected
  ///   ranges of the calibration are positive
  /// - 0 <= min_range < max_range, and working_distance is positive and lies in this interval
  /// - noise parameters are finite and positive; modulation frequency, minimum amplitude and single
  ///   terms of a sum may be 0
  /// - T_flange_camera is rigid within 1e-3, body_size is positive, and no sigma is negative
  void validate() const;

  bool operator==(const Sensor&) const = default;
};

/// Names of the presets: sr4000, azure_kinect_nfov, kinect_v1, d435 and laser_line. laser_line is a
/// scanner with one line per pose (640x1 px, sigmas 0.2 mm, 0.1-1.0 m). The other presets are real
/// cameras, and include the size of the housing. The size of kinect_v1 is approximate and excludes
/// the foot.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& sensor_preset_names();

/// The preset of this name. Throws Error(invalid_argument) listing the valid names.
[[nodiscard]] VIEWGAIN_EXPORT Sensor sensor_preset(std::string_view name);

/// Description of a sensor in TOML, in the format of apps/docs/reference/formats.md.
/// read_sensor_toml() of viewgain::formats reads it and returns an equal sensor. The sensor is not
/// checked.
[[nodiscard]] VIEWGAIN_EXPORT std::string sensor_toml(const Sensor& sensor);

/// Name of the noise model, as in sensor_toml(): shot, structured_light, stereo, quadratic or
/// constant. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view noise_model_name(const NoiseModel& noise);

/// Default of sigma_0, the standard deviation of the surface position in an unknown voxel [m]:
/// max(voxel_size / 2, 2 sigma_ax). sigma_ax is the axial sigma at the working distance and frontal
/// incidence. `voxel_size` is the edge of a voxel [m]. Throws Error(invalid_argument) unless it is
/// positive and finite.
[[nodiscard]] VIEWGAIN_EXPORT double default_prior_sigma(double voxel_size, const Sensor& sensor);

}  // namespace viewgain
