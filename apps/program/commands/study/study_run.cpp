// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/study_run.hpp"

#include <algorithm>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/json_text.hpp"
#include "program/commands/reconstruct/run.hpp"
#include "program/commands/reconstruct/run_options.hpp"
#include "program/commands/reconstruct/run_report.hpp"
#include "program/commands/study/prediction.hpp"
#include "program/commands/study/results.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

// As the command line of `reconstruct` has them.
ReconstructOptions options_of(const StudySpec& spec, const StudyRun& run) {
  App app("", "reconstruct");
  ReconstructOptions options;
  add_options(app, options);
  (void)app.parse(reconstruct_words(spec, run));
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

Json prediction_json(const PredictionQuality& quality) {
  return {{"view", quality.view},
          {"candidates", quality.outcomes.size()},
          {"spearman_area", quality.spearman_area},
          {"spearman_entropy", quality.spearman_entropy},
          {"top1_share", quality.top1_share}};
}

std::string rows_of(const PredictionQuality& quality) {
  std::string rows;
  for (std::size_t i = 0; i < quality.outcomes.size(); ++i) {
    const CandidateOutcome& outcome = quality.outcomes[i];
    rows += std::to_string(quality.view) + "," + std::to_string(i);
    for (const double value : {outcome.score, outcome.predicted_area, outcome.new_samples,
                               outcome.new_area, outcome.entropy_removed}) {
      rows.append(",").append(exact_text(value));
    }
    const Pose& T_world_camera = outcome.candidate.T_world_camera;
    const Eigen::Vector3d t = T_world_camera.translation();
    const Eigen::Quaterniond q(T_world_camera.rotation());
    rows.append(",").append(csv_text(outcome.candidate.generator));
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      rows.append(",").append(exact_text(value));
    }
    rows += "\n";
  }
  return rows;
}

std::optional<StudyResult> result_of(const StudySpec& spec, const StudyRun& study_run, int threads,
                                     const std::stop_token& stop) {
  const ReconstructOptions options = options_of(spec, study_run);
  const ExecConfig exec{threads, parse_tracer(options.common.trace)};
  RunSetup setup = set_up(options, exec);
  setup.planning.stop = stop;
  Run run(std::move(setup), options.frames_per_view, exec);
  RunReport report(run.setup().policy);
  StudyResult result;
  Json prediction = Json::array();
  const std::vector<std::size_t>& views = spec.prediction.views;
  StageSeconds seconds;
  const PlanningResult planned = run.go([&](const ViewRecord& record) {
    for (const auto& [stage, value] : record.seconds) seconds[stage] += value;
    report.add_view(record, run.model().quality().back(), run.model().realised_area(), seconds);
    const bool is_asked = std::find(views.begin(), views.end(), record.index + 1) != views.end();
    if (!is_asked || stop.stop_requested()) return;
    const Stopwatch watch;
    const PredictionQuality quality = predict(run, record, spec.prediction.candidates, exec, stop);
    seconds["prediction"] += watch.seconds();
    if (quality.outcomes.empty()) return;
    prediction.push_back(prediction_json(quality));
    result.prediction_rows += rows_of(quality);
  });
  if (stop.stop_requested() || planned.reason == StopReason::interrupted) return std::nullopt;
  result.run = {{"configuration", study_run.configuration}};
  result.run.update(report.json(planned.reason));
  result.run["prediction"] = prediction;
  result.run["isa"] = isa_name(select_isa());
  return result;
}

}  // namespace

void check_run(const StudySpec& spec, const StudyRun& run) {
  named(spec, run, [&] { return set_up(options_of(spec, run), ExecConfig{}); });
}

std::optional<StudyResult> make_run(const StudySpec& spec, const StudyRun& run, int threads,
                                    const std::stop_token& stop) {
  return named(spec, run, [&] { return result_of(spec, run, threads, stop); });
}

}  // namespace viewgain::app
