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
  std::size_t positionals = 0;
  bool has_mark = false;  ///< a bare --, after which all words are positionals
};

/// The options of a subcommand and of the groups in it, positionals among them, in their order.
[[nodiscard]] std::vector<const Option*> all_options(const App& subcommand);

/// The subcommand that the first word names; null where it is a flag or there is none. Throws
/// Error(invalid_argument) for another word, naming the nearest subcommand.
[[nodiscard]] const App* subcommand_of(const App& program, const std::vector<std::string>& words);

/// Sorts the words after the subcommand. Throws Error(invalid_argument) for a flag that is not
/// there, naming the nearest, and for one whose value is missing.
[[nodiscard]] GivenWords sort_words(const App& subcommand, const std::vector<std::string>& words);

}  // namespace viewgain::app
