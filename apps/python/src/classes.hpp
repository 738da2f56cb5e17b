// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"

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

/// Gives the class to_bytes() and from_bytes(), and pickles and copies by them: by name, so that
/// pickles outlive the extension's own names. What a subclass adds is not ours to keep. `what` the
/// class is and `notes` on to_bytes() are for the docstrings.
template <typename Class, typename To, typename From>
void pickle_as_bytes(Class& type, const char* what, const char* notes, To to_bytes,
                     From from_bytes) {
  const std::string head = std::string("The ") + what;
  const std::string to_doc =
      head + " as bytes, for ``from_bytes`` and pickles" + notes + "\n\nReturns\n-------\nbytes";
  const std::string from_doc =
      head + " that ``to_bytes`` wrote, equal to it.\n\nParameters\n----------\ndata : bytes" +
      "\n\nReturns\n-------\n" + type.attr("__name__").template cast<std::string>();
  type.def("to_bytes", to_bytes, to_doc.c_str());
  type.def_static("from_bytes", from_bytes, pybind11::arg("data"), from_doc.c_str());
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

// Values as bytes, for to_bytes() and pickles: what they are of, arrays with their lengths, and a
// hash of all that. Numbers are in the machine's byte order; in another one's the hash differs.

[[nodiscard]] inline std::uint64_t hash_of_bytes(std::string_view bytes) {
  Hash64 hash;
  hash.add_bytes(bytes);
  return hash.value();
}

class SealedWriter {
 public:
  explicit SealedWriter(std::string_view kind) : bytes_(kind) {}

  template <typename T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(std::uint64_t{values.size()});
    if (!values.empty()) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
  }
  /// All of it; nothing can be added afterwards.
  [[nodiscard]] const std::string& seal() {
    append(hash_of_bytes(bytes_));
    return bytes_;
  }

 private:
  void append(std::uint64_t number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  std::string bytes_;
};

/// Throws Error(format) where the bytes are not whole, or of another kind.
class SealedReader {
 public:
  /// `bytes` must live as long; `what` is for messages.
  SealedReader(std::string_view kind, std::string_view bytes, std::string what)
      : what_(std::move(what)), left_(bytes) {
    if (bytes.size() < kind.size() + sizeof(std::uint64_t) || !bytes.starts_with(kind)) refuse();
    left_.remove_suffix(sizeof(std::uint64_t));
    std::uint64_t hash = 0;
    std::memcpy(&hash, bytes.data() + left_.size(), sizeof hash);
    if (hash != hash_of_bytes(left_)) refuse();
    left_.remove_prefix(kind.size());
  }

  template <typename T>
  [[nodiscard]] std::vector<T> next() {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = 0;
    if (left_.size() < sizeof count) refuse();
    std::memcpy(&count, left_.data(), sizeof count);
    left_.remove_prefix(sizeof count);
    if (count > left_.size() / sizeof(T)) refuse();
    std::vector<T> values(static_cast<std::size_t>(count));
    if (!values.empty()) std::memcpy(values.data(), left_.data(), values.size() * sizeof(T));
    left_.remove_prefix(values.size() * sizeof(T));
    return values;
  }
  void require_end() const {
    if (!left_.empty()) refuse();
  }
  [[noreturn]] void refuse() const {
    throw Error(ErrorCode::format, "these bytes are no " + what_ + " that to_bytes() made");
  }

 private:
  std::string what_;
  std::string_view left_;
};

}  // namespace viewgain::python
