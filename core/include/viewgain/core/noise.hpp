// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Smallest cosine of the angle of incidence, which is the angle between the ray and the surface
/// normal. Noise models clamp smaller values to it.
inline constexpr double kMinCosIncidence = 0.1;

/// Smallest range [m] along the ray. Noise models clamp smaller ranges to it, so that a sigma is
/// never 0 and an information matrix is never infinite.
inline constexpr double kMinNoiseRange = 1e-3;

/// Shot noise of a time-of-flight camera. In this header, t is the range along the ray [m], theta
/// the angle of incidence and cos its cosine. sigma_ax and sigma_lat are standard deviations along
/// and across the ray [m]. The amplitude of the signal is proportional to cos / t².
/// - sigma_ax = reference_sigma * (t / reference_range) * sqrt(reference_integration_time /
/// integration_time) / sqrt(max(cos, 0.1))
/// - sigma_lat = t / fx, the width of a pixel at this range
///
/// The last two members do not affect the sigmas.
struct VIEWGAIN_EXPORT ShotNoise {
  double reference_sigma = 4.0e-3;             ///< [m]
  double reference_range = 1.30;               ///< [m]
  double reference_integration_time = 8.5e-3;  ///< [s]
  double integration_time = 1.0e-3;            ///< [s]
  double modulation_frequency = 30e6;  ///< modulation of the light [Hz]; 0: no ambiguity of ranges
  double min_amplitude = 0.01;  ///< amplitude cos / t² below which a pixel is invalid [m⁻²]
  bool operator==(const ShotNoise&) const = default;
};

/// Structured light (Nguyen, Izadi, Lovell, 3DIMPVT 2012). Their z is replaced by the range t. The
/// term with `grazing` is added only if theta is above 60°.
/// - sigma_ax = offset + quadratic (t - vertex)² + grazing / sqrt(t) * theta² / (pi/2 - theta)²
/// - sigma_lat = (lateral_px + lateral_grazing_px * theta / (pi/2 - theta)) * t / fx
struct VIEWGAIN_EXPORT StructuredLightNoise {
  double offset = 1.2e-3;             ///< [m]
  double quadratic = 1.9e-3;          ///< [1/m]
  double vertex = 0.4;                ///< [m]
  double grazing = 1.0e-4;            ///< [m^1.5]
  double lateral_px = 0.8;            ///< [px]
  double lateral_grazing_px = 0.035;  ///< [px]
  bool operator==(const StructuredLightNoise&) const = default;
};

/// Stereo: sigma_ax = t² * subpixel / (focal * baseline); sigma_lat = t / fx. `focal` is the focal
/// length of the images that are matched.
struct VIEWGAIN_EXPORT StereoNoise {
  double subpixel = 0.08;  ///< matching error [px]
  double focal = 0;        ///< [px]; 0: the camera's fx
  double baseline = 0.05;  ///< [m]

  /// The focal length to use [px]: `focal`, or `fx` if `focal` is 0.
  [[nodiscard]] double focal_with(double fx) const { return focal > 0 ? focal : fx; }
  bool operator==(const StereoNoise&) const = default;
};

/// Quadratic polynomial: sigma_ax = offset + linear * t + quadratic * t²; sigma_lat = t / fx.
struct VIEWGAIN_EXPORT QuadraticNoise {
  double offset = 1.0e-3;       ///< [m]
  double quadratic = 1.074e-3;  ///< [1/m]
  double linear = 0;            ///< dimensionless
  bool operator==(const QuadraticNoise&) const = default;
};

/// Constant sigmas. If both are equal, the noise is isotropic.
struct VIEWGAIN_EXPORT ConstantNoise {
  double sigma_axial = 1.0e-3;    ///< [m]
  double sigma_lateral = 1.0e-3;  ///< [m]
  bool operator==(const ConstantNoise&) const = default;
};

inline constexpr double kSpeedOfLight = 299'792'458.0;  ///< [m/s]

/// Standard deviations of one reading (one measured depth).
struct VIEWGAIN_EXPORT MeasurementSigmas {
  double axial = 0;    ///< along the ray [m]
  double lateral = 0;  ///< across it [m]
};

/// Noise model of a sensor's readings.
using NoiseModel =
    std::variant<ShotNoise, StructuredLightNoise, StereoNoise, QuadraticNoise, ConstantNoise>;

/// Sigmas of a reading at range t [m], for a camera with focal length fx [px]. cos_incidence is the
/// cosine of the angle between surface normal and ray; 1 is frontal. Ranges below kMinNoiseRange
/// and cosines outside [kMinCosIncidence, 1] are clamped. Thread safe; takes a few flops.
[[nodiscard]] VIEWGAIN_EXPORT MeasurementSigmas sigmas(const NoiseModel&, double t, double fx,
                                                       double cos_incidence = 1.0);

/// Standard deviation of a reading along the surface normal [m]: √((σ_ax cosθ)² + (σ_lat sinθ)²),
/// where cosθ is cos_incidence. Arguments are not checked.
[[nodiscard]] VIEWGAIN_EXPORT double sigma_along_normal(const MeasurementSigmas& sigmas,
                                                        double cos_incidence);

/// A reading counts as one of a known surface if it is nearer to this surface, along the surface
/// normal, than this number of standard deviations.
inline constexpr double kKnownSigmas = 3;

/// Whether a reading shows a known plane. `height` [m] is the height of the reading above the
/// plane. `rise` is the height that the ray gains per metre; negative: it descends. True if the
/// reading lies below the plane. Also true if the ray descends and the reading lies less than
/// kKnownSigmas standard deviations above the plane. False if `height` is NaN.
[[nodiscard]] VIEWGAIN_EXPORT bool is_of_plane(double height, double rise,
                                               const MeasurementSigmas& sigmas);

/// Unambiguous range c / (2 modulation_frequency) [m], after which the phase of the light repeats.
/// Infinity if the model has no modulation frequency, or a modulation frequency of 0.
[[nodiscard]] VIEWGAIN_EXPORT double unambiguous_range(const NoiseModel&);

}  // namespace viewgain
