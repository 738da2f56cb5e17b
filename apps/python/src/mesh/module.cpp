// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/pybind11.h>

namespace viewgain::python {

// The parts of the module.
void bind_surface(pybind11::module_&), bind_boundary(pybind11::module_&),
    bind_reconstruct(pybind11::module_&);

}  // namespace viewgain::python

PYBIND11_MODULE(_mesh, module) {
  module.doc() = "The C++ part of viewgain.mesh. Import viewgain.mesh instead.";
  // Sensors, grids and exception types are defined there.
  pybind11::module_::import("viewgain._viewgain");
  const pybind11::object name = module.attr("__name__");
  module.attr("__name__") = "viewgain.mesh";
  viewgain::python::bind_surface(module);
  viewgain::python::bind_boundary(module);
  viewgain::python::bind_reconstruct(module);
  module.attr("__name__") = name;
}
