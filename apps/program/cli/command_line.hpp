// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/flags/common_options.hpp"

namespace viewgain::app {

/// The program without subcommands: -h, --help, --version and the global options, which are allowed
/// before and after the subcommand's name. `common` must outlive the program.
[[nodiscard]] std::unique_ptr<App> make_program(CommonOptions& common);

/// Parses the words, first word first; --config supplies flags that the words do not give. Returns
/// the called subcommand, or null if help or the version was printed. Throws UsageError, which
/// names the nearest known name for an unknown one, and the successor of a removed name.
[[nodiscard]] const App* parse(App& program, const std::vector<std::string>& words);

/// What is wrong with a folder without a map that a parsed call names as MAP or MESH, such as a
/// folder of frames, which belongs to `model`; empty if nothing.
[[nodiscard]] std::string fault_of_folder(const App& called);

}  // namespace viewgain::app
