// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Kind of error. The message of the Error names the value, line or file.
enum class ErrorCode {
  invalid_argument,  ///< a value outside its documented range
  io,                ///< a file cannot be opened, read or written
  format,            ///< a file's contents are invalid
  capacity,          ///< more voxels, primitives or memory than the data structures support
  backend,           ///< Embree or OpenVDB reported a failure
};

/// The only exception type that the library defines. The comment of a function states when it
/// throws. Scoring an invalid pose does not throw. A value type.
class VIEWGAIN_EXPORT Error : public std::runtime_error {
 public:
  /// `message` names the offending value.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// The kind of error.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// Throws Error(invalid_argument).
[[noreturn]] inline void refuse(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

}  // namespace viewgain
