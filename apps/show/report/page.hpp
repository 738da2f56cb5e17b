// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "program/cli/json.hpp"

namespace viewgain::app {

/// Throws Error(invalid_argument), naming the flag and what to install, in a program that was built
/// where npm was missing, so that there is no page to put data into.
void check_report_page(std::string_view flag);

/// The page with these data in it: `page`, or the one that the program was built with. Text that is
/// not UTF-8 is shown with replacement characters; nothing in the data can end the element that
/// holds them. Throws Error(format) unless the page has the place for data once.
[[nodiscard]] std::string report_page(const Json& data);
[[nodiscard]] std::string report_page(const Json& data, std::string_view page);

/// Atomic: a temporary file is renamed. Throws Error(io).
void write_report(const std::filesystem::path& path, const Json& data);

}  // namespace viewgain::app
