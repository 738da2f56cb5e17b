// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace viewgain::app {

/// The script that draws a study's plots, plots.py.
[[nodiscard]] const char* plots_script();

/// Runs a study folder's plots.py by python3. Whether it went well; what it says is dropped.
[[nodiscard]] bool draw_plots(const std::filesystem::path& script);

}  // namespace viewgain::app
