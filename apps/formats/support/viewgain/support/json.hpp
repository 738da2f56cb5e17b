// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

/// The value, or null if it is empty.
template <typename Value>
struct nlohmann::adl_serializer<std::optional<Value>> {
  template <typename Json>
  static void to_json(Json& json, const std::optional<Value>& value) {
    json = value ? Json(*value) : Json(nullptr);
  }
};

namespace viewgain::app {

/// JSON of --json, run.json and results.json. Objects keep the order of their keys.
using Json = nlohmann::ordered_json;

/// A text, or null for an empty one.
[[nodiscard]] inline Json or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

/// As text, indented by this many blanks per level, or in one line. Bytes that are not UTF-8 are
/// replaced, because a file name may contain any bytes.
[[nodiscard]] inline std::string dumped(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Largest depth of nested lists and objects that parse_or_null() accepts.
inline constexpr std::size_t kMostJsonLevels = 1000;

/// Whether brackets outside of strings are nested deeper than kMostJsonLevels.
[[nodiscard]] inline bool is_too_deep(const std::string& text) {
  std::size_t levels = 0;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_in_string = !is_in_string;
    if (is_in_string) {
      i += c == '\\' ? 1 : 0;
    } else if (c == '[' || c == '{') {
      if (++levels > kMostJsonLevels) return true;
    } else if ((c == ']' || c == '}') && levels > 0) {
      --levels;
    }
  }
  return false;
}

/// Null for a text that is not JSON or that is_too_deep(), because copies of values are recursive.
[[nodiscard]] inline Json parse_or_null(const std::string& text) {
  if (is_too_deep(text)) return {};
  Json parsed = Json::parse(text, nullptr, false);
  if (parsed.is_discarded()) return {};
  return parsed;
}

[[nodiscard]] inline Json to_json(const Box& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

[[nodiscard]] inline Json to_json(const Pose& pose) {
  const auto& m = pose.m;
  return {{m[0], m[1], m[2], m[3]},
          {m[4], m[5], m[6], m[7]},
          {m[8], m[9], m[10], m[11]},
          {0.0, 0.0, 0.0, 1.0}};
}

/// The sigmas [m, deg]; null if both are 0.
[[nodiscard]] inline Json pose_sigma_json(const PoseSigma& sigma) {
  if (sigma == PoseSigma{}) return {};
  return {sigma.translation, sigma.rotation * 180 / std::numbers::pi};
}

/// The key `seconds`: the duration of each stage, and their sum.
[[nodiscard]] inline Json seconds_json(const std::map<std::string, double>& seconds) {
  Json json = seconds;
  double total = 0;
  for (const auto& [stage, value] : seconds) total += value;
  json["total"] = total;
  return json;
}

/// The text of run.json and --json.
[[nodiscard]] inline std::string json_text(const Json& json) { return dumped(json, 2) + "\n"; }

inline void print_json(const Json& json) { std::fputs(json_text(json).c_str(), stdout); }

}  // namespace viewgain::app
