// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "program/commands/proposal/view_proposal.hpp"
#include "program/commands/reconstruct/run_options.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain::app {

/// Flags of `viewgain model`.
struct ModelOptions {
  CommonOptions common;
  FrameMapOptions frames;
  ProposalOptions proposal;
  std::size_t top = 10;
  RegistrationOptions registration;
  RunOutputs outputs;
  bool watch = false;  ///< --watch: waits for more frames
  // Only with --watch: number of views after which next.json has a stop_reason.
  std::size_t max_views = PlannerConfig{}.max_views;
  std::string stop;
};

void add_model_options(App& app, ModelOptions& options);

/// Puts the existing frames into a map and writes the run's folder. Throws Error.
void model_recorded_frames(const ModelOptions& options, const App& app);

/// Takes frames as they arrive, until a signal or the file `done`. Throws Error.
void model_arriving_frames(const ModelOptions& options);

}  // namespace viewgain::app
