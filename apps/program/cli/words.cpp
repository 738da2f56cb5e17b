// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/words.hpp"

#include <algorithm>
#include <cctype>

#include "program/cli/values.hpp"
#include "viewgain/support/nearest_name.hpp"

namespace viewgain::app {
namespace {

[[noreturn]] void refuse(const App& subcommand, const std::string& flag, std::string what) {
  if (!subcommand.name().empty() && subcommand.has_parent()) {
    what.append(" (see viewgain ").append(subcommand.name()).append(" --help)");
  }
  app::refuse(flag + ": " + what);
}

// What the first positional of a form is called.
std::string source_of(const App& form) {
  for (const Option* option : form.options()) {
    if (!option->nonpositional()) return option->name();
  }
  return {};
}

[[noreturn]] void refuse_unknown(const App& subcommand, const std::string& flag) {
  for (const App* form : subcommand.forms()) {
    if (form == &subcommand || form->find_option(flag) == nullptr) continue;
    refuse(subcommand, flag, "goes with " + source_of(*form) + ", not " + source_of(subcommand));
  }
  std::vector<std::string> flags;
  for (const Option* option : all_options(subcommand)) {
    if (option->nonpositional()) flags.push_back(option->name());
  }
  refuse(
      subcommand, flag,
      std::string("no such flag of ").append(subcommand.name()).append(did_you_mean(flag, flags)));
}

[[noreturn]] void refuse_without_value(const App& subcommand, const Option& option) {
  const std::vector<std::string> choices = option.choices();
  std::string what = "needs a value";
  if (!choices.empty()) what.append("; there are ").append(listed(choices));
  refuse(subcommand, option.name(), what);
}

// No subcommand has any but -h; a number may stand for a name.
bool is_short_flag(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && word != "-h" &&
         std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

bool is_flag(const std::string& word) { return word.size() > 2 && word.starts_with("--"); }

}  // namespace

std::vector<const Option*> all_options(const App& subcommand) {
  std::vector<const Option*> options = subcommand.options();
  for (const App* group : subcommand.subcommands()) {
    if (!group->name().empty()) continue;
    for (const Option* option : all_options(*group)) {
      if (option != group->help_option()) options.push_back(option);  // the subcommand has its own
    }
  }
  return options;
}

std::vector<const Option*> options_of_forms(const App& subcommand) {
  std::vector<const Option*> options;
  std::set<std::string> names;
  for (const App* form : subcommand.forms()) {
    for (const Option* option : all_options(*form)) {
      if (names.insert(option->name()).second) options.push_back(option);
    }
  }
  return options;
}

const App* subcommand_of(const App& program, const std::vector<std::string>& words) {
  if (words.empty() || words[0].starts_with("-")) return nullptr;
  std::vector<std::string> names;
  for (const App* subcommand : program.subcommands()) {
    if (subcommand->name() == words[0]) return subcommand;
    names.push_back(subcommand->name());
  }
  const std::string nearest = did_you_mean(words[0], names);
  app::refuse(words[0] + ": no such subcommand" +
              (nearest.empty() ? "; there are " : nearest + " There are ") + listed(names));
}

GivenWords sort_words(const App& subcommand, const std::vector<const Option*>& options,
                      const std::vector<std::string>& words) {
  GivenWords given;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (given.has_mark || !words[i].starts_with("--")) {
      if (!given.has_mark && is_short_flag(words[i])) refuse_unknown(subcommand, words[i]);
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
      return option->nonpositional() && option->name() == flag;
    });
    if (found == options.end()) refuse_unknown(subcommand, flag);
    given.options.insert(*found);
    if ((*found)->is_bare() || equals != std::string::npos) continue;
    if (i + 1 == words.size() || words[i + 1] == "--" || is_flag(words[i + 1])) {
      refuse_without_value(subcommand, **found);
    }
    ++i;
  }
  return given;
}

}  // namespace viewgain::app
