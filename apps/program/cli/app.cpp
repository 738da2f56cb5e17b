// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/app.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "program/cli/values.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

std::string shown(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "{" : ",").append(name);
  return text + "}";
}

[[noreturn]] void refuse(const App& subcommand, const std::string& flag, std::string what) {
  const std::string name = name_of(subcommand);
  if (name != "viewgain") what.append(" (see viewgain ").append(name).append(" --help)");
  app::refuse(flag + ": " + what);
}

// What the first positional of a form is called.
std::string source_of(const App& form) {
  for (const Option* option : form.get_options()) {
    if (!option->nonpositional()) return option->get_name();
  }
  return {};
}

[[noreturn]] void refuse_unknown(const App& subcommand, const Forms& forms,
                                 const std::string& flag) {
  for (const App* form : forms) {
    if (form == &subcommand || form->get_option_no_throw(flag) == nullptr) continue;
    refuse(subcommand, flag, "goes with " + source_of(*form) + ", not " + source_of(subcommand));
  }
  std::vector<std::string> flags;
  for (const Option* option : all_options(subcommand)) {
    const std::string name = option->get_name();
    if (option->nonpositional()) flags.push_back(name);
    if (flag == "--" + CLI::detail::to_lower(name)) {  // a positional's
      refuse(subcommand, flag, name + " is given without a flag");
    }
  }
  refuse(subcommand, flag, "no such flag of " + name_of(subcommand) + did_you_mean(flag, flags));
}

[[noreturn]] void refuse_without_value(const App& subcommand, const Option& option) {
  const std::vector<std::string> choices = choices_of(option);
  std::string what = "needs a value";
  if (!choices.empty()) what.append("; there are ").append(listed(choices));
  refuse(subcommand, option.get_name(), what);
}

// No subcommand has any but -h; a number may stand for a name.
bool is_short_flag(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && word != "-h" &&
         std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

bool is_flag(const std::string& word) { return word.size() > 2 && word.starts_with("--"); }

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
  app.add_option(name, value, help)->check(on_or_off());
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

GivenWords sort_words(const App& subcommand, const Forms& forms,
                      const std::vector<const Option*>& options,
                      const std::vector<std::string>& words) {
  GivenWords given;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (given.has_mark || !words[i].starts_with("--")) {
      if (!given.has_mark && is_short_flag(words[i])) refuse_unknown(subcommand, forms, words[i]);
      if (given.has_mark || words[i] != "-h") given.positionals.push_back(words[i]);
      continue;
    }
    if (words[i] == "--") {
      given.has_mark = true;
      continue;
    }
    const std::size_t equals = words[i].find('=');
    const std::string flag = words[i].substr(0, equals);
    const auto found = std::find_if(options.begin(), options.end(), [&](const Option* option) {
      return option->nonpositional() && option->get_name() == flag;
    });
    if (found == options.end()) refuse_unknown(subcommand, forms, flag);
    given.options.insert(*found);
    if (is_bare(**found) || equals != std::string::npos) continue;
    if (i + 1 == words.size() || words[i + 1] == "--" || is_flag(words[i + 1])) {
      refuse_without_value(subcommand, **found);
    }
    ++i;
  }
  return given;
}

}  // namespace viewgain::app
