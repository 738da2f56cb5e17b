// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

#include "viewgain/support/text.hpp"

namespace viewgain::python {

// Common to all classes of the package: construction, use before construction, and pickling.

/// Called when pybind11 needs memory for an object without a value.
template <typename Class>
[[noreturn]] void* refuse_uninitialized(std::size_t) {
  const auto name = pybind11::type::of<Class>().attr("__name__").template cast<std::string>();
  throw pybind11::type_error(name + ".__init__ has not been called on this object");
}

/// A class of the module. Using an object before __init__ raises TypeError, for example after
/// X.__new__(X), or in a subclass before super().__init__(). Take such objects by reference or
/// pointer, not by holder.
template <typename Class, typename... Options>
[[nodiscard]] pybind11::class_<Class, Options...> bound_class(pybind11::module_& module,
                                                              const char* name, const char* doc) {
  pybind11::class_<Class, Options...> type(module, name, doc);
  pybind11::detail::get_type_info(std::type_index(typeid(Class)))->operator_new =
      &refuse_uninitialized<Class>;
  return type;
}

// Every class defines pickling, because Python's default with protocols 0 and 1 ends the process:
// pybind11's base class cannot be constructed alone.

/// Pickles and copies as a call of the class with the keywords of `keywords_of(self)`.
template <typename Class, typename Keywords>
void pickle_as_call(Class& type, Keywords keywords_of) {
  type.def("__reduce_ex__", [keywords_of](const pybind11::object& self, int) {
    const pybind11::dict keywords = keywords_of(self);
    const pybind11::object partial = pybind11::module_::import("functools").attr("partial");
    return pybind11::make_tuple(partial(pybind11::type::of(self), **keywords), pybind11::tuple());
  });
}

/// As above, with these attributes as keywords.
template <typename Class>
void pickle_by_attributes(Class& type, std::vector<const char*> attributes) {
  pickle_as_call(type, [names = std::move(attributes)](const pybind11::object& self) {
    pybind11::dict keywords;
    for (const char* name : names) keywords[name] = self.attr(name);
    return keywords;
  });
}

/// Refuses pickling with TypeError, like Python for objects that cannot be pickled.
template <typename Class>
void refuse_pickling(Class& type) {
  type.def("__reduce_ex__", [](const pybind11::object& self, int) -> pybind11::object {
    const auto name = pybind11::type::of(self).attr("__name__").cast<std::string>();
    throw pybind11::type_error("cannot pickle '" + name + "' object");
  });
}

/// The text of a repr(): name=value, name=value.
class Fields {
 public:
  Fields& add(const char* name, double value) {
    if (!text_.empty()) text_ += ", ";
    text_.append(name).append("=").append(short_text(value));
    return *this;
  }
  [[nodiscard]] std::string in(const char* type) const {
    return std::string(type) + "(" + text_ + ")";
  }

 private:
  std::string text_;
};

}  // namespace viewgain::python
