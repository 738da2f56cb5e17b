// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "program/commands/reconstruct/run_options.hpp"
#include "show/report/run_page.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/run_folder.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// A step of a run as it is to be shown. `evaluator` is of the model's scene.
struct ShownStep {
  const ViewRecord& record;
  const SurfaceModel& model;
  const CandidateGeneration& generation;
  const GainEvaluator& evaluator;
  const Sensor& sensor;
};

/// Draws a step into views/NN.png and puts it onto the page, as the outputs ask; boundaries and
/// candidates where it has a proposal. Returns what `pictures` and `report` took. Throws as
/// view_picture() and write_png().
StageSeconds show_step(const RunOutputs& outputs, const RunFolder& folder, RunPage& page,
                       const ShownStep& step, const ExecConfig& exec);

/// `settings` and `versions`, with which run.json begins.
[[nodiscard]] Json run_head(const Json& settings);

/// Writes the flags of the call into config.toml, for --config, and puts the folder in its place;
/// `run` is what run.json holds.
void commit(RunFolder& folder, const Json& run, const App& app);

/// Says where the run lies; `files` are those that every such run leaves.
void print_left(const RunOutputs& outputs, const char* files);

}  // namespace viewgain::app
