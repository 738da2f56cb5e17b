// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <utility>

namespace viewgain::python {

// What calls return when it is more than one thing: named tuples, whose classes are Python's. All
// need the GIL.

/// A named tuple of a module with these values, in the order of its fields.
template <typename... Values>
[[nodiscard]] pybind11::object named_in(const char* module, const char* type, Values&&... values) {
  return pybind11::module_::import(module).attr(type)(std::forward<Values>(values)...);
}
/// The same of viewgain.results.
template <typename... Values>
[[nodiscard]] pybind11::object named(const char* type, Values&&... values) {
  return named_in("viewgain.results", type, std::forward<Values>(values)...);
}

}  // namespace viewgain::python
