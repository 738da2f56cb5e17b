// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "status.hpp"

#include <array>
#include <cstdio>
#include <new>

namespace viewgain::c_api {
namespace {

// An array, so that storing a message cannot fail.
thread_local std::array<char, 1024> last_error{};

vg_status keep(vg_status status, const char* message) noexcept {
  std::snprintf(last_error.data(), last_error.size(), "%s", message);
  return status;
}

vg_status status_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::invalid_argument:
      return VG_INVALID_ARGUMENT;
    case ErrorCode::io:
      return VG_IO;
    case ErrorCode::format:
      return VG_FORMAT;
    case ErrorCode::capacity:
      return VG_CAPACITY;
    case ErrorCode::backend:
      return VG_BACKEND;
  }
  return VG_INTERNAL;
}

}  // namespace

vg_status status_of_exception() noexcept {
  try {
    throw;
  } catch (const Error& error) {
    return keep(status_of(error.code()), error.what());
  } catch (const Stopped& stopped) {
    return keep(VG_STOPPED, stopped.what());
  } catch (const std::bad_alloc&) {
    return keep(VG_OUT_OF_MEMORY, "out of memory");
  } catch (const std::length_error&) {  // from a container, for an excessive count
    return keep(VG_OUT_OF_MEMORY, "out of memory: a count exceeds any possible memory");
  } catch (const std::exception& error) {
    return keep(VG_INTERNAL, error.what());
  } catch (...) {
    return keep(VG_INTERNAL, "internal error: an exception of an unknown type");
  }
}

}  // namespace viewgain::c_api

int32_t vg_abi_version(void) { return VG_ABI_VERSION; }
const char* vg_version(void) { return VIEWGAIN_VERSION; }
const char* vg_last_error(void) { return viewgain::c_api::last_error.data(); }
