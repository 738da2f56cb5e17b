// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace viewgain {
namespace {

double clamped_cos(double cos_incidence) {
  return std::clamp(cos_incidence, kMinCosIncidence, 1.0);
}

double clamped_range(double t) { return std::max(t, kMinNoiseRange); }

MeasurementSigmas sigmas_of(const ShotNoise& noise, double t, double fx, double cos_incidence) {
  t = clamped_range(t);
  const double axial = noise.reference_sigma * (t / noise.reference_range) *
                       std::sqrt(noise.reference_integration_time / noise.integration_time) /
                       std::sqrt(clamped_cos(cos_incidence));
  return {axial, t / fx};
}

MeasurementSigmas sigmas_of(const StructuredLightNoise& noise, double t, double fx,
                            double cos_incidence) {
  t = clamped_range(t);
  const double theta = std::acos(clamped_cos(cos_incidence));
  const double rest = std::numbers::pi / 2.0 - theta;
  const double offset_range = t - noise.vertex;
  double axial = noise.offset + noise.quadratic * offset_range * offset_range;
  if (theta > std::numbers::pi / 3.0) {
    axial += noise.grazing / std::sqrt(t) * (theta * theta) / (rest * rest);
  }
  return {axial, (noise.lateral_px + noise.lateral_grazing_px * theta / rest) * t / fx};
}

MeasurementSigmas sigmas_of(const StereoNoise& noise, double t, double fx,
                            double /*cos_incidence*/) {
  t = clamped_range(t);
  return {t * t * noise.subpixel / (noise.focal_with(fx) * noise.baseline), t / fx};
}

MeasurementSigmas sigmas_of(const QuadraticNoise& noise, double t, double fx,
                            double /*cos_incidence*/) {
  t = clamped_range(t);
  return {noise.offset + (noise.linear + noise.quadratic * t) * t, t / fx};
}

MeasurementSigmas sigmas_of(const ConstantNoise& noise, double /*t*/, double /*fx*/,
                            double /*cos_incidence*/) {
  return {noise.sigma_axial, noise.sigma_lateral};
}

}  // namespace

MeasurementSigmas sigmas(const NoiseModel& noise, double t, double fx, double cos_incidence) {
  return std::visit([&](const auto& model) { return sigmas_of(model, t, fx, cos_incidence); },
                    noise);
}

double sigma_along_normal(const MeasurementSigmas& sigmas, double cos_incidence) {
  const double squared_sine = std::max(0.0, 1.0 - cos_incidence * cos_incidence);
  return std::sqrt(sigmas.axial * sigmas.axial * cos_incidence * cos_incidence +
                   sigmas.lateral * sigmas.lateral * squared_sine);
}

bool is_of_plane(double height, double rise, const MeasurementSigmas& sigmas) {
  return height < 0 || (rise < 0 && height < kKnownSigmas * sigma_along_normal(sigmas, -rise));
}

double unambiguous_range(const NoiseModel& noise) {
  const auto* shot = std::get_if<ShotNoise>(&noise);
  if (shot == nullptr || !(shot->modulation_frequency > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  return kSpeedOfLight / (2.0 * shot->modulation_frequency);
}

}  // namespace viewgain
