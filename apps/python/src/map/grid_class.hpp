// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "shared_grid.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::python {

using GridClass = pybind11::class_<SharedGrid, std::shared_ptr<SharedGrid>>;

/// Adds reading and writing of files.
void bind_grid_files(GridClass& grid_class);
/// Adds functions for single voxels.
void bind_voxels(GridClass& grid_class);

/// Throws Error(invalid_argument) if both are missing. A default of half a voxel would make unknown
/// voxels more certain than a reading if voxels are finer than the noise.
inline void require_prior(std::optional<double> prior_sigma, const Sensor* sensor) {
  if (prior_sigma || sensor != nullptr) return;
  refuse("give sensor, or prior_sigma: the standard deviation of an unknown voxel's position [m]");
}

/// The prior sigma [m] of a grid: the given one, else the sensor's default. Throws like
/// require_prior().
[[nodiscard]] inline double prior_of(std::optional<double> prior_sigma, const Sensor* sensor,
                                     double voxel_size) {
  require_prior(prior_sigma, sensor);
  return prior_sigma ? *prior_sigma : default_prior_sigma(voxel_size, *sensor);
}

}  // namespace viewgain::python
