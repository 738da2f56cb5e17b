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

/// A command line that is not as its App declares it.
class UsageError : public Error {
 public:
  using Error::Error;
};

// What a value may be, as help shows it.

[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& names, const char* what);
/// Several of the names with commas.
[[nodiscard]] CLI::Validator several_of(const std::vector<std::string>& names, const char* what);
[[nodiscard]] CLI::Validator on_or_off();
[[nodiscard]] CLI::Validator counted(std::size_t least, std::size_t most);
/// With the same bounds in every subcommand.
[[nodiscard]] CLI::Validator a_seed();

/// A switch that shows its default.
void add_switch(App& app, const std::string& name, std::string& value, const std::string& help);

/// The options of a subcommand and of the groups in it, positionals among them, in their order.
[[nodiscard]] std::vector<const Option*> all_options(const App& subcommand);
/// Those, then what the program itself has.
[[nodiscard]] std::vector<const Option*> options_of_call(const App& subcommand);
/// What an option takes by one_of() or several_of(), else nothing.
[[nodiscard]] std::vector<std::string> choices_of(const Option& option);
/// Whether it stands alone, without a value.
[[nodiscard]] inline bool is_bare(const Option& option) {
  return option.get_items_expected_max() == 0;
}

}  // namespace viewgain::app
