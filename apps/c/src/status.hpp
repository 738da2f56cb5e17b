// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

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

/// The sizes that a struct has had in headers of this ABI version, ascending. One that grows gets a
/// specialisation with the offset of the first new field of each header before today's size; that
/// field must not lie in the padding at the end of the smaller struct.
template <typename Struct>
struct Sizes {
  static constexpr std::array known{sizeof(Struct)};
};

template <>
struct Sizes<vg_sensor> {
  static constexpr std::array known{offsetof(vg_sensor, pose_sigma), sizeof(vg_sensor)};
};

template <>
struct Sizes<vg_feasibility_config> {
  static constexpr std::array known{offsetof(vg_feasibility_config, num_threads),
                                    sizeof(vg_feasibility_config)};
};

template <>
struct Sizes<vg_scene_config> {
  static constexpr std::array known{offsetof(vg_scene_config, object_size),
                                    offsetof(vg_scene_config, hazard_rates),
                                    sizeof(vg_scene_config)};
};

template <>
struct Sizes<vg_grid_info> {
  static constexpr std::array known{offsetof(vg_grid_info, hazard_factors), sizeof(vg_grid_info)};
};

template <>
struct Sizes<vg_evaluator_config> {
  static constexpr std::array known{offsetof(vg_evaluator_config, refinement_weight),
                                    sizeof(vg_evaluator_config)};
};

template <>
struct Sizes<vg_view_gain> {
  static constexpr std::array known{offsetof(vg_view_gain, area), sizeof(vg_view_gain)};
};

template <>
struct Sizes<vg_contribution> {
  static constexpr std::array known{offsetof(vg_contribution, expected_rays),
                                    sizeof(vg_contribution)};
};

/// What a struct's _init sets; zeros unless specialised.
template <typename Struct>
[[nodiscard]] Struct defaults() noexcept {
  return {};
}

/// Throws Error(invalid_argument) for a size that the struct never had.
inline void require_known_size(std::size_t size, std::span<const std::size_t> known,
                               const std::string& name) {
  if (std::find(known.begin(), known.end(), size) != known.end()) return;
  std::string text =
      "the size of " + name + " is " + std::to_string(size) + " bytes; this library, ";
  text += VIEWGAIN_VERSION ", knows ";
  for (const std::size_t one : known) {
    if (one != known.front()) text += " and ";
    text += std::to_string(one);
  }
  if (size > known.back()) text += ": the header is newer than the library";
  reject(text);
}

/// A struct that the caller has initialised, or for the library to fill.
template <typename Struct>
void require_struct(const Struct* value, const std::string& name) {
  require(value, name.c_str());
  require_known_size(value->struct_size, Sizes<Struct>::known,
                     name + " (struct_size, set by its _init)");
}

/// A struct of the caller's, which may be of an older header: what it lacks has its default.
template <typename Struct>
[[nodiscard]] Struct read_struct(const Struct* value, const std::string& name) {
  require_struct(value, name);
  Struct whole = defaults<Struct>();
  std::memcpy(static_cast<void*>(&whole), value, value->struct_size);
  return whole;
}

/// The same where null stands for all defaults.
template <typename Struct>
[[nodiscard]] Struct read_config(const Struct* value, const std::string& name) {
  return value == nullptr ? defaults<Struct>() : read_struct(value, name);
}

/// Fills a struct that require_struct() has seen, as far as it reaches.
template <typename Struct>
void write_struct(Struct* value, Struct whole) noexcept {
  whole.struct_size = value->struct_size;
  std::memcpy(static_cast<void*>(value), &whole, whole.struct_size);
}

/// Fills an array of items whose size, known, is the caller's.
template <typename Item, typename Own, typename Convert>
void write_items(std::span<const Own> own, Item* items, std::size_t item_size,
                 const Convert& convert) {
  auto* out = reinterpret_cast<std::byte*>(items);
  for (const Own& one : own) {
    const Item whole = convert(one);
    std::memcpy(out, &whole, item_size);
    out += item_size;
  }
}

/// Writes the defaults as far as the caller's struct reaches, which may be of another version.
template <typename Struct>
void initialise(Struct* value, std::size_t struct_size) noexcept {
  Struct whole = defaults<Struct>();
  if (value == nullptr || struct_size < sizeof(whole.struct_size)) return;
  whole.struct_size = struct_size;
  std::memset(static_cast<void*>(value), 0, struct_size);
  std::memcpy(static_cast<void*>(value), &whole, std::min(struct_size, sizeof whole));
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
