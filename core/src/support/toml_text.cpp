// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/toml_text.hpp"

#include <array>
#include <cstdio>

#include "viewgain/support/text.hpp"

namespace viewgain {

// A TOML float needs a point or an exponent.
std::string toml_float(double value) {
  std::string text = short_text(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string toml_string(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      std::array<char, 8> escaped{};
      std::snprintf(escaped.data(), escaped.size(), "\\u%04X", static_cast<unsigned char>(c));
      text += escaped.data();
    } else {
      text.append(c == '"' || c == '\\' ? "\\" : "").append(1, c);
    }
  }
  return text + "\"";
}

}  // namespace viewgain
