// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "program/cli/app.hpp"

namespace viewgain::app {

/// Writes what is installed of the help into a folder: man1/viewgain.1, man1/viewgain-SUBCOMMAND.1,
/// bash-completion/completions/viewgain, zsh/site-functions/_viewgain. Throws Error(io).
void write_help_files(const App& program, const std::filesystem::path& folder);

}  // namespace viewgain::app
