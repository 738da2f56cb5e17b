// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/commands/reconstruct/run_options.hpp"
#include "show/report/run_page.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// A step of a run for pictures. `evaluator` must be that of the model's scene.
struct ShownStep {
  const ViewRecord& record;
  const SurfaceModel& model;
  const CandidateGeneration& generation;
  const GainEvaluator& evaluator;
  const Sensor& sensor;
};

/// Draws a step to views/NN.png and adds it to the page, according to the outputs; with boundaries
/// and candidates if there is a proposal. Returns the duration of `pictures` and `report`. Throws
/// like view_picture() and write_png().
StageSeconds show_step(const RunOutputs& outputs, const RunFolder& folder, RunPage& page,
                       const ShownStep& step, const ExecConfig& exec);

/// `settings` and `versions`, the first keys of run.json.
[[nodiscard]] Json run_head(const Json& settings);

/// What must be equal for a run to be resumed with identical results: run_head(), the instruction
/// set, all `flags` of the parsed call except kSameBytes, and the `files` that they name.
[[nodiscard]] Json checkpoint_head(const Json& settings, const App& app);

/// Keys of flags that may differ: output folder, speed, display, and what is made only at the end.
inline const std::vector<std::string> kSameBytes{"out",   "resume", "threads", "trace",
                                                 "quiet", "json",   "report"};

/// Data of the run that --report names, for the page: name, settings and views; null without one.
/// Throws Error(io) and Error(format), naming the file.
[[nodiscard]] Json beside_json(const RunOutputs& outputs);

/// Text about the results of the run of beside_json(), and its settings that differ from `own`;
/// empty for null.
[[nodiscard]] std::string beside_text(const Json& beside, const Json& own);

/// Writes the flags of the call to config.toml, for --config, and run.json with the contents `run`,
/// and commits the folder.
void commit(RunFolder& folder, const Json& run, const App& app);

/// Prints where the results are; `files` are those that every such run writes.
void print_left(const RunOutputs& outputs, const char* files);

/// Quality of a surface and its points relative to the reference mesh, with the keys of run.json.
/// `visible` is the key for the coverage of visible samples.
[[nodiscard]] Json quality_json(const QualityFigures& quality, const char* visible);

/// Results of a run, for run.json, --json and the terminal. apps/docs/reference/json.md lists the
/// keys.
class RunReport {
 public:
  /// `tolerance` is that of coverage [m].
  RunReport(const PolicyConfig& policy, double tolerance);

  /// Call it once per view, in order. `seconds` are the totals so far.
  void add_view(const ViewRecord& record, const QualityFigures& quality,
                const StageSeconds& seconds);

  /// One line about the last view.
  [[nodiscard]] std::string progress_line() const;

  /// Final registration of each view; empty without registration.
  void set_registrations(std::vector<FrameRegistration> registrations);

  /// The keys of `reconstruct --json`.
  [[nodiscard]] Json json(StopReason reason) const;

  /// The same as text.
  [[nodiscard]] std::string text(StopReason reason) const;

 private:
  /// The last proposal. A run that uses up its budget of views makes none after the last view.
  [[nodiscard]] const Proposal& last_proposal() const;
  struct Entry {
    ViewRecord record;
    QualityFigures quality;
    StageSeconds seconds;  ///< of this view alone
  };
  [[nodiscard]] Json entry_json(std::size_t index) const;

  std::string ranked_by_;  ///< name of the gain; empty if the policy does not rank by a gain
  std::string_view gain_unit_, entropy_unit_;
  double tolerance_;  ///< of coverage [m]
  std::vector<Entry> views_;
  std::vector<FrameRegistration> registrations_;
  StageSeconds totals_;
};

}  // namespace viewgain::app
