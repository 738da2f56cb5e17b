// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "program/cli/app.hpp"

namespace viewgain::app {

/// The option takes one of these names, which help and completion show; check_one_of() refuses
/// others.
void one_of(Option& option, const std::vector<std::string>& names, const char* what);

/// Likewise for several of them with commas.
void several_of(Option& option, const std::vector<std::string>& names, const char* what);

/// The option takes on or off.
void on_or_off(Option& option);

/// The option takes a seed, with the same bounds in every subcommand, and shows its default.
void takes_seed(Option& option);

/// What an option takes that one_of() or several_of() was called for, else nothing.
[[nodiscard]] std::vector<std::string> choices_of(const Option& option);

}  // namespace viewgain::app
