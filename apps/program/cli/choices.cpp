// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/choices.hpp"

#include <cstdint>

#include "program/cli/values.hpp"

namespace viewgain::app {

namespace {

std::string shown(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "{" : ",").append(name);
  return text + "}";
}

}  // namespace

void one_of(Option& option, const std::vector<std::string>& names, const char* what) {
  option.check(
      [flag = option.name(), names, what](std::string& value) {
        check_one_of(flag, value, names, what);
        return std::string();
      },
      shown(names));
}

void several_of(Option& option, const std::vector<std::string>& names, const char* what) {
  option.check(
      [flag = option.name(), names, what](std::string& value) {
        (void)parse_names(flag, value, names, what);
        return std::string();
      },
      shown(names));
}

void on_or_off(Option& option) { one_of(option, {"on", "off"}, "position of a switch"); }

void takes_seed(Option& option) {
  option.range(std::uint64_t{0}, std::uint64_t{1} << 62U, "number")->capture_default_str();
}

std::vector<std::string> choices_of(const Option& option) {
  const std::string type = option.type_name();
  const std::size_t begin = type.find('{');
  std::vector<std::string> names;
  if (begin == std::string::npos) return names;
  std::string rest = type.substr(begin + 1, type.find('}') - begin - 1);
  for (std::size_t comma = rest.find(','); comma != std::string::npos; comma = rest.find(',')) {
    names.push_back(rest.substr(0, comma));
    rest.erase(0, comma + 1);
  }
  names.push_back(rest);
  return names;
}

}  // namespace viewgain::app
