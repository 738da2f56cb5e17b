// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace viewgain::python {

/// The parts of the module viewgain._viewgain, in the order in which they need each other.
void bind_errors(pybind11::module_& module);
void bind_fork();
void bind_control(pybind11::module_& module);
void bind_noise(pybind11::module_& module);
void bind_camera(pybind11::module_& module);
void bind_sensors(pybind11::module_& module);
void bind_generators(pybind11::module_& module);
void bind_grid(pybind11::module_& module);
void bind_integrator(pybind11::module_& module);
void bind_cloud(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_reach(pybind11::module_& module);
void bind_feasibility(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_evaluator(pybind11::module_& module);
void bind_files(pybind11::module_& module);
void bind_parts(pybind11::module_& module);
void bind_planner(pybind11::module_& module);

}  // namespace viewgain::python
