// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <set>
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

/// Parses words, the first one first. False where --help or --version was printed. Throws
/// UsageError.
[[nodiscard]] bool parse(App& app, std::vector<std::string> words);

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
/// "score" of a subcommand and of its other form.
[[nodiscard]] std::string name_of(const App& subcommand);
/// What an option takes by one_of() or several_of(), else nothing.
[[nodiscard]] std::vector<std::string> choices_of(const Option& option);
/// Whether it stands alone, without a value.
[[nodiscard]] inline bool is_bare(const Option& option) {
  return option.get_items_expected_max() == 0;
}

/// What is given on the command line of a subcommand itself.
struct GivenWords {
  std::set<const Option*> options;
  std::vector<std::string> positionals;
  bool has_mark = false;  ///< a bare --, after which all words are positionals
};

/// A subcommand and, where it has one, its other form, which takes flags of its own.
using Forms = std::vector<App*>;

/// Sorts the words after the subcommand, which may name these options. Throws
/// Error(invalid_argument) for another flag, naming the one of `forms` that it goes with or the
/// nearest, and for one whose value is missing.
[[nodiscard]] GivenWords sort_words(const App& subcommand, const Forms& forms,
                                    const std::vector<const Option*>& options,
                                    const std::vector<std::string>& words);

}  // namespace viewgain::app
