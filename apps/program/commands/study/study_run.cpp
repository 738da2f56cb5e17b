// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/study_run.hpp"

#include <utility>

#include "program/cli/app.hpp"
#include "program/commands/reconstruct/run.hpp"
#include "program/commands/reconstruct/run_options.hpp"
#include "program/commands/reconstruct/run_outputs.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::app {
namespace {

// `count` of a list, evenly spread over it; all if there are no more.
std::vector<Candidate> evenly(const std::vector<Candidate>& from, std::size_t count) {
  if (from.size() <= count) return from;
  std::vector<Candidate> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(from[i * from.size() / count]);
  return some;
}

// As the command line of `reconstruct` has them.
ReconstructOptions options_of(const StudySpec& spec, const StudyRun& run) {
  App app("", "reconstruct");
  ReconstructOptions options;
  add_options(app, options);
  parse_words(app, reconstruct_words(spec, run));
  return options;
}

// Calls `work`; its errors name the run.
template <typename Work>
auto named(const StudySpec& spec, const StudyRun& run, Work&& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.code(), name_of(spec, run) + ": " + error.what());
  }
}

std::optional<StudyResult> result_of(const StudySpec& spec, const StudyRun& study_run,
                                     const ExecConfig& exec, const std::stop_token& stop) {
  const ReconstructOptions options = options_of(spec, study_run);
  RunSetup setup = set_up(options, exec);
  setup.planning.stop = stop;
  RunParts run(std::move(setup), options.frames_per_view, exec);
  RunReport report(run.setup.policy, spec.tolerance);
  StudyResult result;
  StageSeconds seconds;
  const auto watch_view = [&](const ViewRecord& record) {
    for (const auto& [stage, value] : record.seconds) seconds[stage] += value;
    report.add_view(record, run.model.quality().back(), seconds);
    for (const Candidate& candidate : evenly(record.proposal.candidates, spec.kept_candidates)) {
      result.candidates.push_back(candidate.T_world_camera);
      result.candidate_views.push_back(static_cast<double>(record.index + 1));
    }
  };
  const PlanningResult planned =
      active_view_planning(run.setup.start, run.acquisition, run.representation(), run.decision,
                           run.decision, run.setup.planning, watch_view);
  if (stop.stop_requested() || planned.reason == StopReason::interrupted) return std::nullopt;
  result.run["configuration"] = study_run.configuration;
  result.run.update(report.json(planned.reason));
  result.run["isa"] = isa_name(select_isa());
  return result;
}

}  // namespace

void check_run(const StudySpec& spec, const StudyRun& run) {
  named(spec, run, [&] { return set_up(options_of(spec, run), ExecConfig{}); });
}

std::optional<StudyResult> make_run(const StudySpec& spec, const StudyRun& run,
                                    const ExecConfig& exec, const std::stop_token& stop) {
  return named(spec, run, [&] { return result_of(spec, run, exec, stop); });
}

}  // namespace viewgain::app
