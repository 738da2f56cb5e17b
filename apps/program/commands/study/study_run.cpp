// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/study_run.hpp"

#include <algorithm>
#include <string>
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

std::string csv_row(const CandidateOutcome& outcome, double score, double predicted_area) {
  std::string row;
  for (const double value :
       {score, predicted_area, outcome.new_samples, outcome.new_area, outcome.entropy_removed}) {
    row.append(",").append(exact_text(value));
  }
  const Pose& T_world_camera = outcome.candidate.T_world_camera;
  const Eigen::Vector3d t = T_world_camera.translation();
  const Eigen::Quaterniond q(T_world_camera.rotation());
  row.append(",").append(csv_text(outcome.candidate.generator));
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    row.append(",").append(exact_text(value));
  }
  return row + "\n";
}

void add_to(StudyResult& result, const StudySpec& spec, const Prediction& prediction) {
  const std::string view = std::to_string(prediction.view);
  for (const PredictionQuality& quality : prediction.by_policy) {
    const std::string& policy = spec.policies[quality.policy].name;
    result.run["prediction"].push_back({{"policy", policy},
                                        {"view", prediction.view},
                                        {"candidates", prediction.outcomes.size()},
                                        {"spearman_area", quality.spearman_area},
                                        {"spearman_entropy", quality.spearman_entropy},
                                        {"top1_share", quality.top1_share}});
    for (std::size_t i = 0; i < prediction.outcomes.size(); ++i) {
      result.prediction_rows +=
          policy + "," + view + "," + std::to_string(i) +
          csv_row(prediction.outcomes[i], quality.scores.score[i], quality.scores.area[i]);
    }
  }
}

// What ranks by the policies whose scores are looked at on a run's maps.
Scorers scorers_of(const StudySpec& spec, const StudyRun& study_run, const Run& run,
                   const ExecConfig& exec) {
  Scorers scorers;
  for (const std::size_t policy : scored_policies(spec, study_run)) {
    StudyRun other = study_run;
    other.policy = policy;
    PolicyConfig config = policy_config(options_of(spec, other));
    config.object = {run.setup().stage.scene, run.truth(), run.setup().simulation};
    scorers.try_emplace(policy, run.model(), run.generation(), run.setup().sensor, config, exec);
  }
  return scorers;
}

std::optional<StudyResult> result_of(const StudySpec& spec, const StudyRun& study_run, int threads,
                                     const std::stop_token& stop) {
  const ReconstructOptions options = options_of(spec, study_run);
  const ExecConfig exec{threads, parse_tracer(options.common.trace)};
  RunSetup setup = set_up(options, exec);
  setup.planning.stop = stop;
  Run run(std::move(setup), options.frames_per_view, exec);
  RunReport report(run.setup().policy, spec.tolerance);
  StudyResult result;
  result.run = {{"prediction", Json::array()}};
  Scorers scorers = scorers_of(spec, study_run, run, exec);
  const std::vector<std::size_t>& views = spec.prediction.views;
  StageSeconds seconds;
  const PlanningResult planned = run.go([&](const ViewRecord& record) {
    for (const auto& [stage, value] : record.seconds) seconds[stage] += value;
    report.add_view(record, run.model().quality().back(), seconds);
    const bool is_asked = std::find(views.begin(), views.end(), record.index + 1) != views.end();
    if (scorers.empty() || !is_asked || stop.stop_requested()) return;
    const Stopwatch watch;
    add_to(result, spec, predict(run, record, scorers, spec.prediction.candidates, exec, stop));
    seconds["prediction"] += watch.seconds();
  });
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

std::optional<StudyResult> make_run(const StudySpec& spec, const StudyRun& run, int threads,
                                    const std::stop_token& stop) {
  return named(spec, run, [&] { return result_of(spec, run, threads, stop); });
}

}  // namespace viewgain::app
