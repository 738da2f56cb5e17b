// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>

#include "viewgain/core/error.hpp"

namespace viewgain::python {

namespace py = pybind11;

// The parts of the module.
void bind_control(py::module_&), bind_noise(py::module_&), bind_camera(py::module_&),
    bind_sensors(py::module_&), bind_generators(py::module_&), bind_grid(py::module_&),
    bind_scene(py::module_&), bind_integrator(py::module_&), bind_cloud(py::module_&),
    bind_reach(py::module_&), bind_feasibility(py::module_&), bind_simulation(py::module_&),
    bind_evaluator(py::module_&), bind_files(py::module_&), bind_planner(py::module_&),
    bind_scorer(py::module_&);

namespace {

// viewgain.Error. Never destroyed, because exceptions can occur until the process ends.
PyObject* error_type = nullptr;

PyObject* python_type(ErrorCode code) {
  if (code == ErrorCode::invalid_argument) return PyExc_ValueError;
  if (code == ErrorCode::io) return PyExc_OSError;
  return error_type;
}

// Debian's OpenVDB loads log4cplus, which starts threads when it is loaded. A forked child does not
// have these threads, but its exit handler waits for them forever. Handlers registered last run
// first, so this one ends the process earlier; Python has then finished, including atexit
// functions. C handlers of the parent are skipped, as they should be in a child that did not exec.
void leave_at_exit() {
  const int failed = on_exit(
      [](int status, void*) {
        std::fflush(nullptr);
        _exit(status);
      },
      nullptr);
  if (failed != 0) throw std::bad_alloc();
}

void bind_errors(py::module_& module) {
  error_type =
      PyErr_NewExceptionWithDoc("viewgain.Error",
                                "A file has invalid contents, a data structure is too small, or "
                                "Embree or OpenVDB failed.\nInvalid arguments raise ValueError. "
                                "Files that cannot be read or written raise OSError.",
                                PyExc_RuntimeError, nullptr);
  if (error_type == nullptr) throw py::error_already_set();
  module.attr("Error") = py::handle(error_type);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      // The text can contain a file name whose bytes are not UTF-8.
      const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(error.what()));
      if (text) PyErr_SetObject(python_type(error.code()), text.ptr());
    }
  });
}

}  // namespace
}  // namespace viewgain::python

PYBIND11_MODULE(_viewgain, module) {
  using namespace viewgain::python;
  module.doc() = "The C++ part of viewgain. Import viewgain instead.";
  module.attr("__version__") = VIEWGAIN_PYTHON_VERSION;
  // Sets the module of classes and functions to the package that users import, for repr, help and
  // pickles.
  const pybind11::object name = module.attr("__name__");
  module.attr("__name__") = "viewgain";
  pybind11::module_::import("os").attr("register_at_fork")(
      pybind11::arg("after_in_child") = pybind11::cpp_function(&leave_at_exit));
  // In order of dependency.
  for (const auto bind :
       {bind_errors, bind_control, bind_noise, bind_camera, bind_sensors, bind_generators,
        bind_grid, bind_scene, bind_integrator, bind_cloud, bind_reach, bind_feasibility,
        bind_simulation, bind_evaluator, bind_files, bind_scorer, bind_planner}) {
    bind(module);
  }
  module.attr("__name__") = name;
}
