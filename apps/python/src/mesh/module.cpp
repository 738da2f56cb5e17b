// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/bindings.hpp"

PYBIND11_MODULE(_mesh, module) {
  module.doc() = "The C++ part of viewgain.mesh; import viewgain.mesh instead.";
  // Sensors, grids and what errors become are defined there.
  pybind11::module_::import("viewgain._viewgain");
  const pybind11::object name = module.attr("__name__");
  module.attr("__name__") = "viewgain.mesh";
  viewgain::python::bind_surface(module);
  viewgain::python::bind_boundary(module);
  viewgain::python::bind_reconstruct(module);
  module.attr("__name__") = name;
}
