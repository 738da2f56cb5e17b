// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// Null where there is none.
template <typename Value>
struct nlohmann::adl_serializer<std::optional<Value>> {
  template <typename Json>
  static void to_json(Json& json, const std::optional<Value>& value) {
    json = value ? Json(*value) : Json(nullptr);
  }
};

namespace viewgain::app {

/// What --json, run.json and results.json hold. Objects keep the order in which their keys came.
using Json = nlohmann::ordered_json;

/// A text, or null for an empty one.
[[nodiscard]] inline Json or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

/// As text, its levels indented by so many blanks, or in one line. Bytes that are no UTF-8 are
/// replaced, as a file name may be any bytes.
[[nodiscard]] inline std::string dumped(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Null for a text that is no JSON.
[[nodiscard]] inline Json parse_or_null(const std::string& text) {
  const Json parsed = Json::parse(text, nullptr, false);
  return parsed.is_discarded() ? Json() : parsed;
}

}  // namespace viewgain::app
