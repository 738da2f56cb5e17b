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

/// What a run that goes on must have as the one that was ended, so that their bytes are the same:
/// run_head(), the instruction set, all `flags` of the parsed call but kSameBytes, and the `files`
/// that they name.
[[nodiscard]] Json checkpoint_head(const Json& settings, const App& app);

/// Keys of flags that may differ: where the run is written, how fast, what is shown of it, and what
/// is made at its end alone.
inline const std::vector<std::string> kSameBytes{"out",   "resume", "threads", "trace",
                                                 "quiet", "json",   "report"};

/// What the page shows of the run that --report names: its name, settings and views; null without
/// one. Throws Error(io) and Error(format), naming the file.
[[nodiscard]] Json beside_json(const RunOutputs& outputs);

/// What the run of beside_json() came to, and which of its settings are others than `own`, for
/// people; empty for null.
[[nodiscard]] std::string beside_text(const Json& beside, const Json& own);

/// Writes the flags of the call into config.toml, for --config, and puts the folder in its place;
/// `run` is what run.json holds.
void commit(RunFolder& folder, const Json& run, const App& app);

/// Says where the run lies; `files` are those that every such run leaves.
void print_left(const RunOutputs& outputs, const char* files);

/// How far a surface and its points are from the truth, by the keys of run.json; `visible` is the
/// key of the share of visible samples.
[[nodiscard]] Json quality_json(const QualityFigures& quality, const char* visible);

/// What a run came to, for run.json, --json and people. apps/docs/reference/json.md names the keys.
class RunReport {
 public:
  /// `tolerance`: of coverage [m].
  RunReport(const PolicyConfig& policy, double tolerance);

  /// To be called once a view, in order. `seconds` are the totals so far.
  void add_view(const ViewRecord& record, const QualityFigures& quality,
                const StageSeconds& seconds);

  /// One line about the last view.
  [[nodiscard]] std::string progress_line() const;

  /// What registration did to each view, in the end; empty without it.
  void set_registrations(std::vector<FrameRegistration> registrations);

  /// The keys of `reconstruct --json`.
  [[nodiscard]] Json json(StopReason reason) const;

  /// The same for people.
  [[nodiscard]] std::string text(StopReason reason) const;

 private:
  /// The latest one that was asked for; a run that ends by its budget asks for none after its last
  /// view.
  [[nodiscard]] const Proposal& last_proposal() const;
  struct Entry {
    ViewRecord record;
    QualityFigures quality;
    StageSeconds seconds;  ///< of this view alone
  };
  [[nodiscard]] Json entry_json(std::size_t index) const;

  std::string ranked_by_;  ///< the gain; empty: the policy ranks by another thing
  std::string_view gain_unit_, entropy_unit_;
  double tolerance_;  ///< of coverage [m]
  std::vector<Entry> views_;
  std::vector<FrameRegistration> registrations_;
  StageSeconds totals_;
};

}  // namespace viewgain::app
