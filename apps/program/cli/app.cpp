// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/app.hpp"

#include "program/cli/values.hpp"

namespace viewgain::app {
namespace {

std::string shown(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "{" : ",").append(name);
  return text + "}";
}

}  // namespace

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

CLI::Validator on_or_off() { return one_of({"on", "off"}, "value"); }

CLI::Validator counted(std::size_t least, std::size_t most) {
  return CLI::Range(least, most, "count");
}

CLI::Validator a_seed() { return CLI::Range(std::size_t{0}, std::size_t{1} << 62U, "number"); }

void add_switch(App& app, const std::string& name, std::string& value, const std::string& help) {
  app.add_option(name, value, help)->check(on_or_off());
}

std::vector<const Option*> all_options(const App& subcommand) {
  std::vector<const Option*> options = subcommand.get_options();
  for (const App* group : subcommand.get_subcommands(nullptr)) {
    if (!group->get_name().empty()) continue;
    for (const Option* option : all_options(*group)) {
      // The subcommand has its own help option.
      if (option != group->get_help_ptr() && option != group->get_help_all_ptr()) {
        options.push_back(option);
      }
    }
  }
  return options;
}

std::vector<const Option*> options_of_call(const App& subcommand) {
  std::vector<const Option*> options = all_options(subcommand);
  if (subcommand.get_parent() != nullptr) {
    const std::vector<const Option*> global = subcommand.get_parent()->get_options();
    options.insert(options.end(), global.begin(), global.end());
  }
  return options;
}

std::vector<std::string> choices_of(const Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  return begin < end ? names_in(type.substr(begin + 1, end - begin - 1))
                     : std::vector<std::string>();
}

}  // namespace viewgain::app
