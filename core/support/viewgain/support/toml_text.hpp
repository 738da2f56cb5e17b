// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// As TOML has them: a number that is read back as it was, a text in quotes, on one line.
[[nodiscard]] VIEWGAIN_EXPORT std::string toml_float(double value);
[[nodiscard]] VIEWGAIN_EXPORT std::string toml_string(const std::string& value);

/// The key `format` of sensors and reach regions; grows when a reader of this one would err.
inline constexpr int kTomlFormat = 1;

}  // namespace viewgain
