// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// What kind of thing went wrong; the message says which value, line or file.
enum class ErrorCode {
  invalid_argument,  ///< a value outside its documented range
  io,                ///< a file cannot be opened, read or written
  format,            ///< a file's contents are not what they should be
  capacity,          ///< more voxels, primitives or memory than the data structures can hold
  backend,           ///< Embree or OpenVDB reported a failure
};

/// The one exception type of the library. Thrown at set-up and by file readers and writers, never
/// from the scoring of a pose. Thread safety: a value type.
class VIEWGAIN_EXPORT Error : public std::runtime_error {
 public:
  /// `message` names the offending value. Both are unchecked.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// What kind of error it is.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// Throws Error(invalid_argument).
[[noreturn]] inline void refuse(const std::string& message) {
  throw Error(ErrorCode::invalid_argument, message);
}

}  // namespace viewgain
