// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "program/cli/app.hpp"
#include "program/commands/reconstruct/run_options.hpp"

namespace viewgain::app {

/// `viewgain reconstruct` of a folder of recorded frames: they are what it acquires, one after the
/// other; the views that it would take next end the run. Leaves the folder that a run on a mesh
/// leaves, and next.txt. Throws Error, naming the flag, for those that only a mesh or a choice of
/// views has a use for.
void reconstruct_frames(const ReconstructOptions& options, const App& app);

}  // namespace viewgain::app
