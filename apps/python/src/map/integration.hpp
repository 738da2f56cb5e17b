// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <string>

#include "named.hpp"
#include "shared_grid.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::python {

// What the integrators of frames and of clouds have in common.

/// Of the docstrings: parameters of the constructors.
inline constexpr const char* kIntegratorSettings =
    R"(occupancy : {"probabilistic", "literal"}
    Log-odds, changed once per voxel and call, or crossed -> free and hit -> occupied.
support_plane : float, optional
    Height z [m] of the table that the object stands on; its readings carve but do not hit.
num_threads : int
    0: all hardware threads. Never changes the map.)";

/// Of the docstrings: what a constructor raises, and what holds for the methods.
inline constexpr const char* kIntegratorRaises = R"(

Raises
------
ValueError
    There is no such setting, or one is out of its bounds.
TypeError
    It is no sensor.

Notes
-----
One call at a time: others wait. The GIL is left while a frame or cloud goes in. Maps are the same
bits for any number of threads.)";

/// Of the docstrings: what integrate() returns and raises.
inline constexpr const char* kIntegrateReturns =
    R"(Returns
-------
IntegrationReport
    Counts: readings, plane_readings, out_of_range, invalid, readings_inside (of pixels or points),
    voxels_hit, voxels_crossed.

Raises
------
ValueError
    Names the shape or dtype, or what is wrong with the pose; or all readings, or 19 in 20 that
    are not alike, are beyond 10 times max_range, as where they are in millimetres. The grid is unchanged then.
TypeError
    It is no grid.)";

[[nodiscard]] inline Occupancy parse_occupancy(const std::string& name) {
  if (name == "probabilistic") return Occupancy::probabilistic;
  if (name == "literal") return Occupancy::literal;
  throw pybind11::value_error("occupancy is \"" + name + "\"; valid are probabilistic literal");
}

[[nodiscard]] inline pybind11::object to_python(const IntegrationReport& r) {
  return named("IntegrationReport", r.readings, r.plane_readings, r.out_of_range, r.invalid,
               r.readings_inside, r.voxels_hit, r.voxels_crossed);
}

/// Python's integrators; one call at a time.
template <typename Integrator>
struct SharedIntegrator {
  Sensor sensor;
  Integrator integrator;
  std::mutex mutex{};

  template <typename Config>
  SharedIntegrator(const Sensor& of, const Config& config, int num_threads)
      : sensor(of), integrator(of, config, ExecConfig{num_threads}) {}

  /// Call with the GIL.
  template <typename Readings, typename... More>
  pybind11::object integrate(SharedGrid& grid, const Readings& readings, const Pose& T_world_sensor,
                             const More&... more) {
    return to_python(grid.write([&](BeliefGrid& g) {
      const std::lock_guard lock(mutex);
      return integrator.integrate(g, readings, T_world_sensor, more...);
    }));
  }
};

}  // namespace viewgain::python
