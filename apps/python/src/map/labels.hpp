// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>

namespace viewgain::python {

using Labels =
    pybind11::array_t<std::uint8_t, pybind11::array::c_style | pybind11::array::forcecast>;

/// Whole numbers of the shape (nx, ny, nz), not yet looked at. Raises ValueError.
[[nodiscard]] pybind11::array any_labels(const pybind11::object& labels);
/// Raises ValueError, naming the labels that are no states.
void require_states(const pybind11::array& labels);

}  // namespace viewgain::python
