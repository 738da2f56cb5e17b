// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/app.hpp"

#include <algorithm>
#include <utility>

#include "program/cli/values.hpp"
#include "viewgain/support/nearest_name.hpp"

namespace viewgain::app {
namespace {

std::string shown(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "{" : ",").append(name);
  return text + "}";
}

}  // namespace

bool parse(App& app, std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app.parse(std::move(words));
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
      throw UsageError(ErrorCode::invalid_argument, error.what());
    }
    app.exit(error);
    return false;
  }
}

CLI::Validator one_of(const std::vector<std::string>& names, const char* what) {
  return {[names, what](std::string& value) { return fault_of_name(value, names, what); },
          shown(names)};
}

CLI::Validator several_of(const std::vector<std::string>& names, const char* what) {
  return {[names, what](std::string& value) {
            std::string fault;
            for (const std::string& name : names_in(value)) {
              if (fault.empty()) fault = fault_of_name(name, names, what);
            }
            return fault;
          },
          shown(names)};
}

CLI::Validator on_or_off() { return one_of({"on", "off"}, "position of a switch"); }

CLI::Validator counted(std::size_t least, std::size_t most) {
  return CLI::Range(least, most, "count");
}

CLI::Validator a_seed() { return CLI::Range(std::size_t{0}, std::size_t{1} << 62U, "number"); }

void add_switch(App& app, const std::string& name, std::string& value, const std::string& help) {
  app.add_option(name, value, help)->capture_default_str()->check(on_or_off());
}

std::vector<const Option*> all_options(const App& subcommand) {
  std::vector<const Option*> options = subcommand.get_options();
  for (const App* group : subcommand.get_subcommands(nullptr)) {
    if (!group->get_name().empty()) continue;
    for (const Option* option : all_options(*group)) {
      if (option != group->get_help_ptr()) options.push_back(option);  // the subcommand has its own
    }
  }
  return options;
}

std::string name_of(const App& subcommand) {
  return subcommand.get_name().substr(subcommand.get_name().rfind(' ') + 1);
}

std::vector<std::string> choices_of(const Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  return begin < end ? names_in(type.substr(begin + 1, end - begin - 1))
                     : std::vector<std::string>();
}

}  // namespace viewgain::app
