// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "viewgain/core/error.hpp"

namespace viewgain::app {

using App = CLI::App;
using Option = CLI::Option;

/// A command line that does not match its App.
class UsageError : public Error {
 public:
  using Error::Error;
};

// Validators, which help shows as the type of a value.

[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& names, const char* what);
/// Several of the names, separated by commas.
[[nodiscard]] CLI::Validator several_of(const std::vector<std::string>& names, const char* what);
[[nodiscard]] CLI::Validator on_or_off();
[[nodiscard]] CLI::Validator counted(std::size_t least, std::size_t most);
/// A seed, with the same bounds in every subcommand.
[[nodiscard]] CLI::Validator a_seed();

/// Adds an on|off switch that shows its default.
void add_switch(App& app, const std::string& name, std::string& value, const std::string& help);

/// The options of a subcommand and of its groups, including positionals, in order.
[[nodiscard]] std::vector<const Option*> all_options(const App& subcommand);
/// As above, followed by the program's own options.
[[nodiscard]] std::vector<const Option*> options_of_call(const App& subcommand);
/// The values that one_of() or several_of() allow for an option; empty for other options.
[[nodiscard]] std::vector<std::string> choices_of(const Option& option);
/// Whether the option takes no value.
[[nodiscard]] inline bool is_bare(const Option& option) {
  return option.get_items_expected_max() == 0;
}

}  // namespace viewgain::app
