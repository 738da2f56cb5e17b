// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/bindings.hpp"

PYBIND11_MODULE(_mesh, module) {
  module.doc() = "The C++ part of viewgain.mesh; import viewgain.mesh instead.";
  // Sensors, grids and what errors become are defined there.
  pybind11::module_::import("viewgain._viewgain");
  viewgain::python::bind_surface(module);
  viewgain::python::bind_reconstruct(module);
}
