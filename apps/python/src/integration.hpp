// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "viewgain/grid/integrate.hpp"

namespace viewgain::python {

// What frames and clouds have in common.

[[nodiscard]] inline Occupancy parse_occupancy(const std::string& name) {
  if (name == "probabilistic") return Occupancy::probabilistic;
  if (name == "literal") return Occupancy::literal;
  throw pybind11::value_error("occupancy is \"" + name + "\"; valid are probabilistic literal");
}

[[nodiscard]] inline pybind11::dict dict_of(const IntegrationReport& report) {
  pybind11::dict result;
  result["readings"] = report.readings;
  result["plane_readings"] = report.plane_readings;
  result["out_of_range"] = report.out_of_range;
  result["invalid"] = report.invalid;
  result["readings_inside"] = report.readings_inside;
  result["voxels_hit"] = report.voxels_hit;
  result["voxels_crossed"] = report.voxels_crossed;
  return result;
}

}  // namespace viewgain::python
