// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// TOML text of a number, which reads back exactly (toml_float), or of a string, quoted on one line
/// (toml_string).
[[nodiscard]] VIEWGAIN_EXPORT std::string toml_float(double value);
[[nodiscard]] VIEWGAIN_EXPORT std::string toml_string(const std::string& value);

/// Value of the key `format` in TOML files of sensors and reach regions. It increases when the
/// format changes in a way that existing programs would misread.
inline constexpr int kTomlFormat = 1;

}  // namespace viewgain
