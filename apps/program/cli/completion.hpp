// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "program/cli/app.hpp"

namespace viewgain::app {

/// A script for bash, or zsh, that completes subcommands, flags and the values that have names;
/// elsewhere it leaves the word to the completion of files.
[[nodiscard]] std::string bash_completion(const App& program);
[[nodiscard]] std::string zsh_completion(const App& program);

}  // namespace viewgain::app
