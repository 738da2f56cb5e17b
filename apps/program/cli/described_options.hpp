// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "program/cli/app.hpp"
#include "program/cli/json.hpp"

namespace viewgain::app {

// Options are described once, by a function template that calls a visitor for each:
//
//   visit.option(key, flag, value, help, adjust)  a flag with a value
//   visit.derived(key)                            what follows from others and is recorded too
//
// `key` is what run.json calls it, null where it cannot change the answer or is recorded elsewhere;
// `adjust(Option&)` adds checks. The visitors below declare the flags and record the values.

inline constexpr auto as_it_is = [](Option&) {};
inline constexpr auto shows_default = [](Option& option) { option.capture_default_str(); };
inline constexpr auto switched = [](Option& option) {
  option.on_or_off();
  option.capture_default_str();
};
inline constexpr auto needed = [](Option& option) { option.required(); };

/// Declares the flags; the values stand for the defaults.
class OptionDeclaration {
 public:
  explicit OptionDeclaration(App& app) : app_(app) {}

  template <typename Value, typename Adjust>
  void option(const char* /*key*/, const char* flag, Value& value, const char* help,
              const Adjust& adjust) const {
    adjust(*app_.add_option(flag, value, help));
  }
  void derived(const char* /*key*/) const {}

 private:
  App& app_;
};

/// Records the values under their keys, in the order of the description. What the run made of an
/// option, `resolved` under the same key, counts instead of what was given. Not given is null.
class OptionRecord {
 public:
  explicit OptionRecord(const Json& resolved) : resolved_(resolved) {}

  template <typename Value, typename Adjust>
  void option(const char* key, const char* /*flag*/, const Value& value, const char* /*help*/,
              const Adjust& /*adjust*/) {
    put(key, value);
  }
  void derived(const char* key) { json_[key] = resolved_.at(key); }

  [[nodiscard]] const Json& json() const noexcept { return json_; }

 private:
  template <typename Value>
  static Json given(const Value& value) {
    return value;
  }
  static Json given(const std::string& text) { return or_null(text); }
  template <typename Value>
  void put(const char* key, const Value& value) {
    if (key != nullptr) json_[key] = resolved_.contains(key) ? resolved_[key] : given(value);
  }

  const Json& resolved_;
  Json json_ = Json::object();
};

}  // namespace viewgain::app
