// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace viewgain::python {

/// The parts of the module viewgain.mesh._mesh, in the order in which they need each other.
void bind_surface(pybind11::module_& module);
void bind_boundary(pybind11::module_& module);
void bind_reconstruct(pybind11::module_& module);

}  // namespace viewgain::python
