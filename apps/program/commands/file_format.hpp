// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// The key `format` of run.json, checkpoint.json and next.json. Increases when readers of this
/// version would misread the file.
inline constexpr std::uint64_t kRunFormat = 1;

/// Throws Error(format), naming file and formats, for a newer format, and Json::exception if it is
/// missing.
inline void check_format(const std::string& file, const Json& json) {
  const auto format = json.at("format").get_ref<const Json::number_unsigned_t&>();
  if (format <= kRunFormat) return;
  throw Error(ErrorCode::format, file + ": the file's format, " + std::to_string(format) +
                                     ", is too new; this program reads formats up to " +
                                     std::to_string(kRunFormat));
}

}  // namespace viewgain::app
