// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include "viewgain/core/error.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/version.hpp"
#include "viewgain/viewgain.h"

namespace viewgain::c_api {

/// A call ended by its vg_watch, once what it has is handed over.
class VIEWGAIN_EXPORT Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Status of the exception in flight; keeps its message for vg_last_error().
VIEWGAIN_EXPORT vg_status status_of_exception() noexcept;

/// Throws Error(invalid_argument) for the first that is null; `names` has theirs, with blanks.
inline void require(std::string_view names, std::initializer_list<const void*> pointers) {
  for (const void* pointer : pointers) {
    const std::string_view name = names.substr(0, names.find(' '));
    if (pointer == nullptr) refuse(std::string(name) + " is null");
    names.remove_prefix(std::min(names.size(), name.size() + 1));
  }
}

/// An array among these, which may be null where it is empty.
[[nodiscard]] inline const void* sized(const void* pointer, std::size_t count) {
  return count > 0 ? pointer : "";
}

/// Runs the body of a function of the C interface, after require(); nothing it throws gets out.
template <typename Body>
vg_status guarded(std::string_view names, std::initializer_list<const void*> pointers,
                  const Body& body) noexcept {
  try {
    require(names, pointers);
    body();
    return VG_OK;
  } catch (...) {
    return status_of_exception();
  }
}

/// What a struct's _init sets; zeros unless specialised.
template <typename Struct>
[[nodiscard]] Struct defaults() noexcept {
  return {};
}

/// Throws Error(invalid_argument) for another size of a struct than it has in this library.
template <typename Struct>
void require_size(std::size_t size, const std::string& name) {
  if (size == sizeof(Struct)) return;
  refuse("the size of " + name + " is " + std::to_string(size) +
         " bytes, but in this library " VIEWGAIN_VERSION ", it is " +
         std::to_string(sizeof(Struct)));
}

/// A struct that the caller has initialised, or for the library to fill.
template <typename Struct>
void require_struct(const Struct* value, const std::string& name) {
  require(name, {value});
  require_size<Struct>(value->struct_size, name + " (struct_size, set by its _init)");
}

/// A struct of the caller's.
template <typename Struct>
[[nodiscard]] Struct read_struct(const Struct* value, const std::string& name) {
  require_struct(value, name);
  return *value;
}

/// The same where null stands for all defaults.
template <typename Struct>
[[nodiscard]] Struct read_config(const Struct* value, const std::string& name) {
  return value == nullptr ? defaults<Struct>() : read_struct(value, name);
}

/// Fills a struct that require_struct() has seen.
template <typename Struct>
void write_struct(Struct* value, Struct whole) noexcept {
  whole.struct_size = sizeof(Struct);
  *value = whole;
}

/// Writes the defaults. A struct of another size, which is another header's, gets zeros and that
/// size, by which all functions refuse it.
template <typename Struct>
void initialise(Struct* value, std::size_t struct_size) noexcept {
  if (value == nullptr || struct_size < sizeof(value->struct_size)) return;
  std::memset(static_cast<void*>(value), 0, std::min(struct_size, sizeof(Struct)));
  if (struct_size == sizeof(Struct)) *value = defaults<Struct>();
  value->struct_size = struct_size;
}

/// The _init of a struct.
#define VG_DEFINE_INIT(name)                               \
  void name##_init(name* value, std::size_t struct_size) { \
    viewgain::c_api::initialise(value, struct_size);       \
  }

/// Makes a handle with what `make` returns; null if it throws. The first name is the handle's.
template <typename Handle, typename Make>
vg_status make_handle(Handle** handle, std::string_view names,
                      std::initializer_list<const void*> pointers, const Make& make) noexcept {
  if (handle != nullptr) *handle = nullptr;
  return guarded(names, {handle}, [&] {
    require(names.substr(std::min(names.size(), names.find(' ') + 1)), pointers);
    *handle = new Handle{make()};
  });
}

}  // namespace viewgain::c_api
