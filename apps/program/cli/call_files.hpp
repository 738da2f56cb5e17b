// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "program/cli/app.hpp"

namespace viewgain::app {

/// Checks rules for the values and files of every subcommand, by the names of its options, before
/// it runs:
/// - no option has an empty value, no output is called "-";
/// - no output is also an input or a second output, under any name, path or link. Inputs include
/// all files in folders of frames and masks and in recordings, and the poses that a reach file
/// names. Only `integrate --map` may name the same file as --out, because it continues a map in
/// place;
/// - output files can be written. Throws Error, naming option and file.
void check_call(const App& subcommand);

}  // namespace viewgain::app
