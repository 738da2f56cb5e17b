// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// A subcommand and, where it has one, its other form, which takes flags of its own.
using Forms = std::vector<App*>;

/// Sorts the words after the subcommand, which may name these options. Throws
/// Error(invalid_argument) for another flag, naming the one of `forms` that it goes with or the
/// nearest, and for one whose value is missing.
[[nodiscard]] GivenWords sort_words(const App& subcommand, const Forms& forms,
                                    const std::vector<const Option*>& options,
                                    const std::vector<std::string>& words);

}  // namespace viewgain::app
