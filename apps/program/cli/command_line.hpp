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

/// Parses the words, first word first; --config supplies flags that the words do not give. Returns
/// the called subcommand, or null if help or the version was printed. Throws UsageError: for an
/// unknown name with the nearest known one, for a removed name with its successor.
[[nodiscard]] const App* parse(App& program, const std::vector<std::string>& words);

/// What is wrong with a folder that a parsed call names as MAP or MESH, which holds no map: frames
/// are for `model`; empty: nothing.
[[nodiscard]] std::string fault_of_folder(const App& called);

}  // namespace viewgain::app
