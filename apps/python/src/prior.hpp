// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain::python {

/// default_prior_sigma() [m]; throws Error(invalid_argument) for a voxel size that is none.
[[nodiscard]] inline double checked_prior_sigma(double voxel_size, const Sensor& sensor) {
  if (!(voxel_size > 0 && std::isfinite(voxel_size))) {
    throw Error(ErrorCode::invalid_argument,
                "voxel_size is " + short_text(voxel_size) + " m; it must be positive and finite");
  }
  return default_prior_sigma(voxel_size, sensor);
}

/// The prior sigma [m] of a grid: the one given, else what suits the sensor, else half a voxel.
[[nodiscard]] inline double prior_of(std::optional<double> prior_sigma, const Sensor* sensor,
                                     double voxel_size) {
  if (prior_sigma) return *prior_sigma;
  return sensor != nullptr ? checked_prior_sigma(voxel_size, *sensor) : 0.5 * voxel_size;
}

}  // namespace viewgain::python
