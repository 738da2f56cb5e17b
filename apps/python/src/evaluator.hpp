// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "named.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::python {

/// Needs the GIL.
[[nodiscard]] inline pybind11::object named_outcomes(const RayOutcomes& of) {
  return named("RayOutcomes", of.rays, of.unknown, of.known_surface, of.obstacle, of.too_near,
               of.out_of_range, of.out_of_map);
}

/// Python's GainEvaluator.
struct Evaluator {
  pybind11::object scene;  ///< the VoxelScene that it was made with
  Sensor sensor;
  std::string criterion;
  int pixel_stride = 1;
  GainEvaluator evaluator;

  [[nodiscard]] int width() const { return (sensor.camera.width - 1) / pixel_stride + 1; }
  [[nodiscard]] int height() const { return (sensor.camera.height - 1) / pixel_stride + 1; }
};

/// What a GainEvaluator's keywords say. Throws ValueError for those that do not go together.
[[nodiscard]] GainConfig gain_config(const std::string& gain, const std::string& criterion,
                                     int pixel_stride, std::optional<double> prior_sigma,
                                     std::optional<double> min_range,
                                     std::optional<double> max_range,
                                     const pybind11::iterable& weights,
                                     std::optional<double> refinement_weight,
                                     bool posterior_entropy);

/// Adds what looks into single views: trace, depth, contributions, gains of the user's own.
void bind_views(pybind11::module_& module, pybind11::class_<Evaluator>& evaluator);

}  // namespace viewgain::python
