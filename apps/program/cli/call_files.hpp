// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "program/cli/app.hpp"

namespace viewgain::app {

/// The rules that hold for the values and files of every subcommand, by the names of its options,
/// before it runs:
/// - no option has an empty value, no output is called "-";
/// - nothing that is written is a file that is read, by whatever name, path or link, or is written
///   twice; that includes the files in a folder of frames, those that a folder to be written
///   replaces, the poses that a reach file names, and all in a recording or a folder of masks. Only
///   `integrate --map` may name its --out: a map is continued where it stands;
/// - a file to be written can be written.
/// Throws Error, naming option and file.
void check_call(const App& subcommand);

}  // namespace viewgain::app
