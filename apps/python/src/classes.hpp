// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

namespace viewgain::python {

// What every class of the package has in common: how it is made, used before it is made, and
// pickled.

/// Where pybind11 asks for memory for the value of an object that has none.
template <typename Class>
[[noreturn]] void* refuse_uninitialized(std::size_t) {
  const auto name = pybind11::type::of<Class>().attr("__name__").template cast<std::string>();
  throw pybind11::type_error(name + ".__init__ has not been called on this object");
}

/// A class of the module. An object without a value, as X.__new__(X) makes one and as a subclass
/// has before it calls super().__init__(), raises TypeError wherever it is used. Take such objects
/// by reference or pointer, not by holder.
template <typename Class, typename... Options>
[[nodiscard]] pybind11::class_<Class, Options...> bound_class(pybind11::module_& module,
                                                              const char* name, const char* doc) {
  pybind11::class_<Class, Options...> type(module, name, doc);
  pybind11::detail::get_type_info(std::type_index(typeid(Class)))->operator_new =
      &refuse_uninitialized<Class>;
  return type;
}

// Every class says how it is pickled: what Python does by itself with the protocols 0 and 1 ends
// the process, because pybind11's base class cannot be made alone.

/// Pickles, and copies, as a call of the class with these attributes as keywords.
template <typename Class>
void pickle_as_call(Class& type, std::vector<const char*> attributes) {
  type.def("__reduce_ex__", [names = std::move(attributes)](const pybind11::object& self, int) {
    pybind11::dict keywords;
    for (const char* name : names) keywords[name] = self.attr(name);
    const pybind11::object partial = pybind11::module_::import("functools").attr("partial");
    return pybind11::make_tuple(partial(pybind11::type::of(self), **keywords), pybind11::tuple());
  });
}

/// Pickles, and copies, as the bytes that to_bytes() gives and from_bytes() takes. By name, so that
/// pickles outlive the extension's own names. What a subclass adds is not ours to keep.
template <typename Class>
void pickle_as_bytes(Class& type) {
  type.def("__reduce_ex__", [](const pybind11::object& self, int) {
    const pybind11::type of_self = pybind11::type::of(self);
    const pybind11::type own = pybind11::type::of<typename Class::type>();
    if (!of_self.is(own)) {
      throw pybind11::type_error(
          "cannot pickle '" + of_self.attr("__name__").template cast<std::string>() +
          "' object: it is a subclass of " + own.attr("__name__").template cast<std::string>());
    }
    const pybind11::object call = pybind11::module_::import("operator").attr("methodcaller");
    return pybind11::make_tuple(call("from_bytes", self.attr("to_bytes")()),
                                pybind11::make_tuple(of_self));
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
