// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace viewgain::app {

/// "--take was removed; use --plan K,M" for a removed subcommand, or a removed flag with its --;
/// empty for another name.
[[nodiscard]] std::string successor_of(std::string_view name);

}  // namespace viewgain::app
