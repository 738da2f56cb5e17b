// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include <exception>

#include "bindings.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::python {

namespace py = pybind11;

namespace {

// viewgain.Error. Alive as long as the process: exceptions may come until the very end.
PyObject* error_type = nullptr;

PyObject* python_type(ErrorCode code) {
  if (code == ErrorCode::invalid_argument) return PyExc_ValueError;
  if (code == ErrorCode::io) return PyExc_OSError;
  return error_type;
}

}  // namespace

void bind_errors(py::module_& module) {
  error_type = PyErr_NewExceptionWithDoc(
      "viewgain.Error",
      "A file's contents are wrong, a data structure is too small for what is asked, or Embree or "
      "OpenVDB\nreported a failure. Wrong arguments raise ValueError, files that cannot be read or "
      "written OSError.",
      PyExc_RuntimeError, nullptr);
  if (error_type == nullptr) throw py::error_already_set();
  module.attr("Error") = py::handle(error_type);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      // The text may have a file's name in it, whose bytes need not be UTF-8.
      const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(error.what()));
      if (text) PyErr_SetObject(python_type(error.code()), text.ptr());
    }
  });
}

}  // namespace viewgain::python

PYBIND11_MODULE(_viewgain, module) {
  using namespace viewgain::python;
  module.doc() = "The C++ part of viewgain; import viewgain instead.";
  module.attr("__version__") = VIEWGAIN_PYTHON_VERSION;
  // Classes and functions are of the package that users import: so say reprs, help and pickles.
  const pybind11::object name = module.attr("__name__");
  module.attr("__name__") = "viewgain";
  bind_errors(module);
  bind_fork();
  bind_control(module);
  bind_noise(module);
  bind_camera(module);
  bind_sensors(module);
  bind_generators(module);
  bind_grid(module);
  bind_scene(module);
  bind_integrator(module);
  bind_cloud(module);
  bind_reach(module);
  bind_feasibility(module);
  bind_simulation(module);
  bind_evaluator(module);
  bind_files(module);
  bind_parts(module);
  bind_planner(module);
  module.attr("__name__") = name;
}
