// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace viewgain::python {

// Every class says how it is pickled: what Python does by itself with the protocols 0 and 1 ends
// the process, because pybind11's base class cannot be made alone.

/// Pickles, and copies, as a call of the class with these attributes as keywords.
template <typename Class>
void pickle_as_call(Class& type, std::initializer_list<const char*> attributes) {
  type.def("__reduce_ex__", [names = std::vector<const char*>(attributes)](
                                const pybind11::object& self, int) {
    pybind11::dict keywords;
    for (const char* name : names) keywords[name] = self.attr(name);
    const pybind11::object partial = pybind11::module_::import("functools").attr("partial");
    return pybind11::make_tuple(partial(pybind11::type::of(self), **keywords), pybind11::tuple());
  });
}

/// Refuses by TypeError, as Python does for what cannot be pickled.
template <typename Class>
void refuse_pickling(Class& type) {
  type.def("__reduce_ex__", [](const pybind11::object& self, int) -> pybind11::object {
    const auto name = pybind11::type::of(self).attr("__name__").cast<std::string>();
    throw pybind11::type_error("cannot pickle '" + name + "' object");
  });
}

}  // namespace viewgain::python
