// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "program/cli/app.hpp"

namespace viewgain::app {

/// viewgain(1) of the program, in roff: what it is, its subcommands by their groups.
[[nodiscard]] std::string man_page(const App& program);

/// viewgain-SUBCOMMAND(1): what its help says.
[[nodiscard]] std::string subcommand_man_page(const App& subcommand);

}  // namespace viewgain::app
