// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "viewgain/core/noise.hpp"

namespace viewgain {

/// A parameter of a noise model.
template <typename Model>
struct NoiseField {
  const char* name;  ///< name in files and in Python
  double Model::*member;
  bool optional = false;     ///< may be missing in files; the model's default is then used
  bool unsaid_at_0 = false;  ///< files omit the parameter if it is 0
  bool may_be_0 = optional;  ///< if false, it must be positive; Sensor::validate() checks sums
};

/// Name of a model in files, and its parameters in the order of vg_sensor::noise of the C
/// interface.
template <typename Model>
struct NoiseLayout;
template <>
struct NoiseLayout<ShotNoise> {
  static constexpr const char* kName = "shot";
  static constexpr std::array<NoiseField<ShotNoise>, 6> kFields{
      {{"reference_sigma", &ShotNoise::reference_sigma},
       {"reference_range", &ShotNoise::reference_range},
       {"reference_integration_time", &ShotNoise::reference_integration_time},
       {"integration_time", &ShotNoise::integration_time},
       {"modulation_frequency", &ShotNoise::modulation_frequency, true},
       {"min_amplitude", &ShotNoise::min_amplitude, true}}};
};
template <>
struct NoiseLayout<StructuredLightNoise> {
  static constexpr const char* kName = "structured_light";
  static constexpr std::array<NoiseField<StructuredLightNoise>, 6> kFields{
      {{"offset", &StructuredLightNoise::offset, false, false, true},
       {"quadratic", &StructuredLightNoise::quadratic, false, false, true},
       {"vertex", &StructuredLightNoise::vertex, false, false, true},
       {"grazing", &StructuredLightNoise::grazing, false, false, true},
       {"lateral_px", &StructuredLightNoise::lateral_px},
       {"lateral_grazing_px", &StructuredLightNoise::lateral_grazing_px, false, false, true}}};
};
template <>
struct NoiseLayout<StereoNoise> {
  static constexpr const char* kName = "stereo";
  static constexpr std::array<NoiseField<StereoNoise>, 3> kFields{
      {{"subpixel", &StereoNoise::subpixel},
       {"focal", &StereoNoise::focal, true, true},
       {"baseline", &StereoNoise::baseline}}};
};
template <>
struct NoiseLayout<QuadraticNoise> {
  static constexpr const char* kName = "quadratic";
  static constexpr std::array<NoiseField<QuadraticNoise>, 3> kFields{
      {{"offset", &QuadraticNoise::offset, false, false, true},
       {"quadratic", &QuadraticNoise::quadratic, false, false, true},
       {"linear", &QuadraticNoise::linear, true, true}}};
};
template <>
struct NoiseLayout<ConstantNoise> {
  static constexpr const char* kName = "constant";
  static constexpr std::array<NoiseField<ConstantNoise>, 2> kFields{
      {{"sigma_axial", &ConstantNoise::sigma_axial},
       {"sigma_lateral", &ConstantNoise::sigma_lateral}}};
};

/// All models with their default parameters, in the order of NoiseModel.
inline const std::array<NoiseModel, 5> kNoiseModels{
    ShotNoise{}, StructuredLightNoise{}, StereoNoise{}, QuadraticNoise{}, ConstantNoise{}};

/// Calls f(double& value, const NoiseField& field) for each parameter of the model.
template <typename F>
void for_each_parameter(NoiseModel& noise, F&& f) {
  std::visit(
      [&f]<typename Model>(Model& model) {
        for (const auto& field : NoiseLayout<Model>::kFields) f(model.*field.member, field);
      },
      noise);
}

}  // namespace viewgain
