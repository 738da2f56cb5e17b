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

/// A call was ended by its vg_watch; its results so far are already written.
class VIEWGAIN_EXPORT Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Status of the current exception; stores its message for vg_last_error().
VIEWGAIN_EXPORT vg_status status_of_exception() noexcept;

/// Throws Error(invalid_argument) for the first null pointer. `names`: their names, separated by
/// blanks.
inline void require(std::string_view names, std::initializer_list<const void*> pointers) {
  for (const void* pointer : pointers) {
    const std::string_view name = names.substr(0, names.find(' '));
    if (pointer == nullptr) refuse(std::string(name) + " is null");
    names.remove_prefix(std::min(names.size(), name.size() + 1));
  }
}

/// For arrays in require(): an empty array may be null.
[[nodiscard]] inline const void* sized(const void* pointer, std::size_t count) {
  return count > 0 ? pointer : "";
}

/// Calls require(), then the body of a C function; exceptions become a status.
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

/// Values that a struct's _init sets; zeros unless specialised.
template <typename Struct>
[[nodiscard]] Struct defaults() noexcept {
  return {};
}

/// Throws Error(invalid_argument) unless a struct has the size that it has in this library.
template <typename Struct>
void require_size(std::size_t size, const std::string& name) {
  if (size == sizeof(Struct)) return;
  refuse("the size of " + name + " is " + std::to_string(size) +
         " bytes, but in viewgain " VIEWGAIN_VERSION " it is " + std::to_string(sizeof(Struct)) +
         "; use the header of this version");
}

/// Throws Error(invalid_argument) for null. Also throws whatever require_size() throws.
template <typename Struct>
void require_struct(const Struct* value, const std::string& name) {
  require(name, {value});
  require_size<Struct>(value->struct_size, name + " (struct_size, set by its _init)");
}

/// A copy of the caller's struct. Throws like require_struct().
template <typename Struct>
[[nodiscard]] Struct read_struct(const Struct* value, const std::string& name) {
  require_struct(value, name);
  return *value;
}

/// Like read_struct(), but null gives the defaults.
template <typename Struct>
[[nodiscard]] Struct read_config(const Struct* value, const std::string& name) {
  return value == nullptr ? defaults<Struct>() : read_struct(value, name);
}

/// Fills a struct that passed require_struct().
template <typename Struct>
void write_struct(Struct* value, Struct whole) noexcept {
  whole.struct_size = sizeof(Struct);
  *value = whole;
}

/// Writes the defaults. A struct of another size, from another version of the header, gets zeros
/// and that size, so that all functions refuse it.
template <typename Struct>
void initialise(Struct* value, std::size_t struct_size) noexcept {
  if (value == nullptr || struct_size < sizeof(value->struct_size)) return;
  std::memset(static_cast<void*>(value), 0, std::min(struct_size, sizeof(Struct)));
  if (struct_size == sizeof(Struct)) *value = defaults<Struct>();
  value->struct_size = struct_size;
}

/// Defines the _init function of a struct.
#define VG_DEFINE_INIT(name)                               \
  void name##_init(name* value, std::size_t struct_size) { \
    viewgain::c_api::initialise(value, struct_size);       \
  }

/// Makes a handle from the result of `make`; null if it throws. The first name is that of the
/// handle.
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
