// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/command_line.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "program/cli/config_file.hpp"
#include "program/cli/help.hpp"
#include "program/cli/successors.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

// The subcommand of this name, or null.
const App* subcommand_of(const App& program, const std::string& word) {
  for (const App* subcommand : program.get_subcommands(nullptr)) {
    if (subcommand->get_name() == word) return subcommand;
  }
  return nullptr;
}

std::string fault_of_subcommand(const App& program, const std::string& word) {
  std::vector<std::string> names;
  for (const App* subcommand : program.get_subcommands(nullptr)) {
    names.push_back(subcommand->get_name());
  }
  return fault_of_name(word, names, "subcommand");
}

std::string fault_of_flag(const App& called, const std::string& flag) {
  std::vector<std::string> flags;
  for (const Option* option : options_of_call(called)) {
    const std::string name = option->get_name();
    if (flag == name) return flag + ": the flag must follow the subcommand " + called.get_name();
    if (option->nonpositional()) flags.push_back(name);
    if (flag == "--" + CLI::detail::to_lower(name)) {  // name of a positional
      return flag + ": " + name + " is a positional argument; give it without --";
    }
  }
  return flag + ": " + called.get_name() + " has no such flag" + did_you_mean(flag, flags);
}

bool is_flag(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && word != "--" &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

// What is wrong with words that no option takes; empty if there are none, or for another error.
std::string fault_of_extras(const App& program, const CLI::ParseError& error) {
  const std::vector<std::string> extras = program.remaining(true);
  const std::vector<App*> called = program.get_subcommands();
  const auto flag = std::find_if(extras.begin(), extras.end(), is_flag);
  if (called.empty()) {
    const auto word = std::find_if_not(extras.begin(), extras.end(), is_flag);
    if (word != extras.end()) {
      const std::string gone = successor_of(*word);
      return gone.empty() ? fault_of_subcommand(program, *word) : gone;
    }
    return flag == extras.end() ? "" : fault_of_flag(program, flag->substr(0, flag->find('=')));
  }
  if (const std::string fault = fault_of_folder(*called.front()); !fault.empty()) return fault;
  if (flag != extras.end()) {
    const std::string name = flag->substr(0, flag->find('='));
    const std::string gone = successor_of(name);
    return gone.empty() ? fault_of_flag(*called.front(), name) : gone;
  }
  const bool is_of_words = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (extras.empty() || !is_of_words) return {};
  return extras.front() + ": " + called.front()->get_name() + " accepts no further arguments";
}

// Refuses a flag in place of a flag's value. A value that begins with -- must be given as
// --flag=--value.
void check_have_values(const App& program, const std::vector<std::string>& words) {
  const App* called = &program;
  for (const std::string& word : words) {
    const App* subcommand = subcommand_of(program, word);
    if (called == &program && subcommand != nullptr) called = subcommand;
  }
  const std::vector<const Option*> options = options_of_call(*called);
  const auto is_long = [](const std::string& word) {
    return word.size() > 2 && word.starts_with("--");
  };
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const auto option = std::find_if(options.begin(), options.end(), [&](const Option* one) {
      return one->nonpositional() && one->get_name() == words[i];
    });
    if (option == options.end() || is_bare(**option)) continue;
    if (i + 1 < words.size() && words[i + 1] != "--" && !is_long(words[i + 1])) {
      ++i;
      continue;
    }
    const std::vector<std::string> choices = choices_of(**option);
    throw UsageError(ErrorCode::invalid_argument,
                     words[i] + ": the flag requires a value" +
                         (choices.empty() ? "" : "; valid values: " + listed(choices)));
  }
}

}  // namespace

std::string fault_of_folder(const App& called) {
  for (const char* name : {"MAP", "MESH"}) {
    const Option* option = called.get_option_no_throw(name);
    if (option == nullptr || option->count() == 0) continue;
    const std::filesystem::path path = option->results().front();
    std::error_code ignored;
    if (!std::filesystem::is_directory(path, ignored) ||
        std::filesystem::exists(map_in(path), ignored)) {
      continue;
    }
    return path.string() +
           ": the folder has no map. To make a map from frames, run viewgain model " +
           path.string() + " --voxel V --out RUN";
  }
  return {};
}

std::unique_ptr<App> make_program(CommonOptions& common) {
  auto program = std::make_unique<App>(
      "viewgain scores camera poses by expected information gain. It simulates or reads depth "
      "frames, integrates the frames into a voxel map and scores candidate views in this map. "
      "Units are m, rad, s and nat unless stated otherwise.",
      "viewgain");
  program->formatter(std::make_shared<HelpFormatter>());
  program->set_help_flag("-h", "print the most common options");
  program->set_help_all_flag("--help", "print all options");
  program->require_subcommand(1);
  program->fallthrough();
  program->option_defaults()->always_capture_default();
  add_common_options(*program, common);
  program->set_version_flag("--version", std::string("viewgain ") + VIEWGAIN_VERSION,
                            "print the version");
  program
      ->set_config("--config", "",
                   "TOML file of flags; keys are flag names without --, or names of positionals "
                   "(mesh, map); flags on the command line take precedence")
      ->type_name("FILE");
  program->config_formatter(std::make_shared<FlagFile>(*program));
  return program;
}

const App* parse(App& program, const std::vector<std::string>& words) {
  check_have_values(program, words);
  try {
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // reversed for CLI11
    return program.get_subcommands().front();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      program.exit(error);
      return nullptr;
    }
    std::string fault = fault_of_extras(program, error);
    if (fault.empty()) fault = error.what();
    const std::vector<App*> called = program.get_subcommands();
    const std::string name = called.empty() ? "" : called.front()->get_name() + " ";
    throw UsageError(ErrorCode::invalid_argument, fault + " (see viewgain " + name + "--help)");
  }
}

}  // namespace viewgain::app
