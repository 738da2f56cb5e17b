// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/flags/common_options.hpp"

namespace viewgain::app {

/// The program without subcommands, which are to be added to it: -h, --help, --version and the
/// global options, which may stand before and after the subcommand's name; `common` must outlive
/// it.
[[nodiscard]] std::unique_ptr<App> make_program(CommonOptions& common);

/// Parses the words, the first one first; what --config names stands for flags that are not among
/// them. The subcommand that was called; null where a help or the version was printed. Throws
/// UsageError, which of an unknown name says the nearest one, and of one that there was once its
/// successor.
[[nodiscard]] const App* parse(App& program, const std::vector<std::string>& words);

}  // namespace viewgain::app
