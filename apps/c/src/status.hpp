// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/viewgain.h"

namespace viewgain::c_api {

/// A call ended by its vg_watch, once what it has is handed over.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Status of the exception in flight; keeps its message for vg_last_error().
vg_status status_of_exception() noexcept;

/// Runs the body of a function of the C interface; nothing it throws gets out.
template <typename Body>
vg_status guarded(const Body& body) noexcept {
  try {
    body();
    return VG_OK;
  } catch (...) {
    return status_of_exception();
  }
}

[[noreturn]] inline void reject(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

inline void require(const void* pointer, const char* name) {
  if (pointer == nullptr) reject(std::string(name) + " is null");
}

/// For arrays, which may be null where they are empty.
inline void require_array(const void* pointer, std::size_t count, const char* name) {
  if (count > 0) require(pointer, name);
}

inline void require_size(std::size_t size, std::size_t known, const std::string& name) {
  if (size == known) return;
  reject("the size of " + name + " is " + std::to_string(size) + " bytes; this library knows " +
         std::to_string(known));
}

/// A struct that the caller has initialised, or for the library to fill.
template <typename Struct>
void require_struct(const Struct* value, const std::string& name) {
  require(value, name.c_str());
  require_size(value->struct_size, sizeof(Struct), name + " (struct_size, set by its _init)");
}

/// Writes the defaults as far as the caller's struct reaches, which may be of another version.
template <typename Struct>
void initialise(Struct* value, std::size_t struct_size, Struct defaults) noexcept {
  if (value == nullptr || struct_size < sizeof(defaults.struct_size)) return;
  defaults.struct_size = struct_size;
  std::memset(static_cast<void*>(value), 0, struct_size);
  std::memcpy(static_cast<void*>(value), &defaults, std::min(struct_size, sizeof defaults));
}

/// Makes a handle with what `make` returns; null if it throws.
template <typename Handle, typename Make>
vg_status make_handle(Handle** handle, const char* name, const Make& make) noexcept {
  if (handle != nullptr) *handle = nullptr;
  return guarded([&] {
    require(handle, name);
    *handle = new Handle{make()};
  });
}

}  // namespace viewgain::c_api
