// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Smallest cosine of incidence in the noise models; smaller values are clamped to it.
inline constexpr double kMinCosIncidence = 0.1;

/// Smallest range [m] in the noise models; nearer readings are clamped to it, so that a sigma is
/// never 0 and an information matrix never infinite.
inline constexpr double kMinNoiseRange = 1e-3;

/// Time-of-flight shot noise. The amplitude decreases with cos / t².
/// - sigma_ax = reference_sigma * (t / reference_range) * sqrt(reference_integration_time /
/// integration_time) / sqrt(max(cos, 0.1))
/// - sigma_lat = t / fx, the pixel footprint
///
/// The last two fields do not affect the sigmas.
struct VIEWGAIN_EXPORT ShotNoise {
  double reference_sigma = 4.0e-3;             ///< [m]
  double reference_range = 1.30;               ///< [m]
  double reference_integration_time = 8.5e-3;  ///< [s]
  double integration_time = 1.0e-3;            ///< [s]
  double modulation_frequency = 30e6;          ///< of the light [Hz]; 0: ranges are unambiguous
  double min_amplitude = 0.01;  ///< cos / t² below which a reading is invalid [m⁻²]
  bool operator==(const ShotNoise&) const = default;
};

/// Structured light (Nguyen, Izadi, Lovell, 3DIMPVT 2012), with z as the range along the ray:
/// - sigma_ax = offset + quadratic (z - vertex)² + grazing / sqrt(z) * theta² / (pi/2 - theta)²,
/// the last term beyond 60°
/// - sigma_lat = (lateral_px + lateral_grazing_px * theta / (pi/2 - theta)) * z / fx
struct VIEWGAIN_EXPORT StructuredLightNoise {
  double offset = 1.2e-3;             ///< [m]
  double quadratic = 1.9e-3;          ///< [1/m]
  double vertex = 0.4;                ///< [m]
  double grazing = 1.0e-4;            ///< [m^1.5]
  double lateral_px = 0.8;            ///< [px]
  double lateral_grazing_px = 0.035;  ///< [px]
  bool operator==(const StructuredLightNoise&) const = default;
};

/// Stereo: sigma_ax = t² * subpixel / (focal * baseline); sigma_lat = t / fx. The focal length of
/// both images is fx, unless `focal` is set.
struct VIEWGAIN_EXPORT StereoNoise {
  double subpixel = 0.08;  ///< matching error [px]
  double focal = 0;        ///< [px]; 0: the camera's fx
  double baseline = 0.05;  ///< [m]

  /// Effective focal length [px] for a camera with fx [px]. Checks nothing.
  [[nodiscard]] double focal_with(double fx) const { return focal > 0 ? focal : fx; }
  bool operator==(const StereoNoise&) const = default;
};

/// sigma_ax = offset + linear * t + quadratic * t²; sigma_lat = t / fx.
struct VIEWGAIN_EXPORT QuadraticNoise {
  double offset = 1.0e-3;       ///< [m]
  double quadratic = 1.074e-3;  ///< [1/m]
  double linear = 0;            ///< dimensionless
  bool operator==(const QuadraticNoise&) const = default;
};

/// Constant sigmas; equal ones make an isotropic sensor.
struct VIEWGAIN_EXPORT ConstantNoise {
  double sigma_axial = 1.0e-3;    ///< [m]
  double sigma_lateral = 1.0e-3;  ///< [m]
  bool operator==(const ConstantNoise&) const = default;
};

inline constexpr double kSpeedOfLight = 299'792'458.0;  ///< [m/s]

/// Standard deviations of one reading, along and across the ray [m].
struct VIEWGAIN_EXPORT MeasurementSigmas {
  double axial = 0;    ///< along the ray [m]
  double lateral = 0;  ///< across it [m]
};

/// Noise model of a sensor's readings.
using NoiseModel =
    std::variant<ShotNoise, StructuredLightNoise, StereoNoise, QuadraticNoise, ConstantNoise>;

/// Sigmas of a reading at range t >= 0 [m] along the ray, for a camera with focal length fx [px].
/// cos_incidence is the cosine of the angle between surface normal and ray (1: frontal). Thread
/// safe; takes a few flops. Checks nothing: a range below kMinNoiseRange and a cosine outside
/// [kMinCosIncidence, 1] are clamped.
[[nodiscard]] VIEWGAIN_EXPORT MeasurementSigmas sigmas(const NoiseModel&, double t, double fx,
                                                       double cos_incidence = 1.0);

/// Standard deviation of a reading along the surface normal [m]: √((σ_ax cosθ)² + (σ_lat sinθ)²),
/// where cosθ is cos_incidence. The lateral sigma matters on slanted surfaces, where a lateral
/// shift changes the depth. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT double sigma_along_normal(const MeasurementSigmas& sigmas,
                                                        double cos_incidence);

/// A reading counts as a reading of a known surface if it is closer than this number of standard
/// deviations, measured along the surface normal.
inline constexpr double kKnownSigmas = 3;

/// Whether a reading shows a known plane. The reading lies `height` [m] above the plane; `rise` [m]
/// is the height that the ray gains over the plane per metre. True if the reading lies below the
/// plane, or if the ray descends and the reading lies less than kKnownSigmas above it. Checks
/// nothing; false for a height of NaN.
[[nodiscard]] VIEWGAIN_EXPORT bool is_of_plane(double height, double rise,
                                               const MeasurementSigmas& sigmas);

/// Unambiguous range c / (2 modulation_frequency) [m], after which the phase of the light repeats.
/// Infinity for models without a modulation frequency.
[[nodiscard]] VIEWGAIN_EXPORT double unambiguous_range(const NoiseModel&);

}  // namespace viewgain
