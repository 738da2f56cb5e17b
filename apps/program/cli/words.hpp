// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "program/cli/app.hpp"

namespace viewgain::app {

/// What is given on the command line of a subcommand itself.
struct GivenWords {
  std::set<const Option*> options;
  std::vector<std::string> positionals;
  bool has_mark = false;  ///< a bare --, after which all words are positionals
};

/// The options of a subcommand and of the groups in it, positionals among them, in their order.
[[nodiscard]] std::vector<const Option*> all_options(const App& subcommand);

/// The subcommand that the first word names; null where it is a flag or there is none. Throws
/// Error(invalid_argument) for another word, naming the nearest subcommand.
[[nodiscard]] const App* subcommand_of(const App& program, const std::vector<std::string>& words);

/// The options of all its forms, each name once.
[[nodiscard]] std::vector<const Option*> options_of_forms(const App& subcommand);

/// Sorts the words after the subcommand, which may name these options. Throws
/// Error(invalid_argument) for another flag, naming the form of the subcommand that it goes with or
/// the nearest, and for one whose value is missing.
[[nodiscard]] GivenWords sort_words(const App& subcommand,
                                    const std::vector<const Option*>& options,
                                    const std::vector<std::string>& words);

}  // namespace viewgain::app
