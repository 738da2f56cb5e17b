// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// TOML text of a number that reads back exactly, and of a quoted string on one line.
[[nodiscard]] VIEWGAIN_EXPORT std::string toml_float(double value);
[[nodiscard]] VIEWGAIN_EXPORT std::string toml_string(const std::string& value);

/// The key `format` of sensors and reach regions. Increases when readers of this version would
/// misread the file.
inline constexpr int kTomlFormat = 1;

}  // namespace viewgain
