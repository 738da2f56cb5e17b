// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/study_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/json_text.hpp"
#include "program/commands/reconstruct/run.hpp"
#include "program/commands/reconstruct/run_options.hpp"
#include "program/commands/reconstruct/run_report.hpp"
#include "program/commands/study/results.hpp"
#include "program/commands/study/statistics.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/isa.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/planner_mesh/oracle_choice.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

// What a candidate was said to bring, and what it truly brings.
struct CandidateOutcome {
  Candidate candidate;
  double score;            // by what the policy ranks by; its unit
  double predicted_area;   // new surface to be expected [m²]; NaN where the gain does not say
  double new_samples;      // of the mesh, that the map's points cover afterwards and not before
  double new_area;         // what these stand for [m²]
  double entropy_removed;  // by the view, in the map's criterion
};

// How well a policy's score of candidates tells what they bring.
struct PredictionQuality {
  std::size_t view = 0;         // after so many views
  double spearman_area = 0;     // of the score with the truly new samples
  double spearman_entropy = 0;  // of the score with the entropy removed
  double top1_share = 0;        // new samples of the favourite / of the best candidate; NaN
                                // where no score is above another
  std::vector<CandidateOutcome> outcomes;
};

// `count` of a list, evenly spread over it; all if there are no more.
std::vector<Candidate> evenly(const std::vector<Candidate>& from, std::size_t count) {
  if (from.size() <= count) return from;
  std::vector<Candidate> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(from[i * from.size() / count]);
  return some;
}

std::vector<Candidate> candidates_of(Run& run, const ViewRecord& record, std::size_t count) {
  // After the last view of the budget nobody has asked for a proposal.
  const std::vector<Candidate> proposed =
      record.proposal.candidates.empty()
          ? run.generation().generate(record.T_world_camera).candidates
          : record.proposal.candidates;
  std::vector<Candidate> candidates = evenly(proposed, count / 2);
  const RunSetup& setup = run.setup();
  const FeasibilityChecker checker(run.model().scene(), run.generation().config().feasibility);
  std::vector<Candidate> sphere;
  const std::vector<Pose> around = sphere_poses(2 * count, setup.distance, setup.stage.center);
  for (const Pose& pose : feasible_poses(checker, around, {}).poses) {
    sphere.push_back({pose, "sphere"});
  }
  for (Candidate& candidate : evenly(sphere, count - candidates.size())) {
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

std::vector<double> column(const std::vector<CandidateOutcome>& outcomes,
                           double CandidateOutcome::*member) {
  std::vector<double> values;
  for (const CandidateOutcome& outcome : outcomes) values.push_back(outcome.*member);
  return values;
}

// Simulates candidates for the next view without noise, one frame each into a copy of the map, and
// holds what comes of it against the policy's scores: half of `count` from the proposal, evenly
// taken from its list, the rest feasible poses of the sphere round the object at the start's
// distance. No outcomes where the policy scores nothing, or if a stop was requested.
PredictionQuality predict(Run& run, const ViewRecord& record, std::size_t count,
                          const ExecConfig& exec, const std::stop_token& stop) {
  PredictionQuality quality;
  quality.view = record.index + 1;
  const std::vector<Candidate> candidates = candidates_of(run, record, count);
  const std::optional<CandidateScores> scores = run.decision().scores(candidates);
  if (!scores) return quality;
  const RunSetup& setup = run.setup();
  const OracleChoice oracle(run.model(), setup.sensor,
                            {setup.stage.scene, run.truth(), setup.simulation}, exec);
  const auto covered = static_cast<double>(oracle.covered());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (stop.stop_requested()) {
      quality.outcomes.clear();
      return quality;
    }
    const TrueOutcome outcome = oracle.outcome_of(candidates[i].T_world_camera);
    const double new_samples = static_cast<double>(outcome.covered) - covered;
    quality.outcomes.push_back({candidates[i], scores->score[i], scores->area[i], new_samples,
                                new_samples * run.truth()->area_per_sample(),
                                outcome.entropy_removed - record.progress.entropy_removed});
  }
  const std::vector<double> score = column(quality.outcomes, &CandidateOutcome::score),
                            added = column(quality.outcomes, &CandidateOutcome::new_samples);
  quality.spearman_area = spearman(score, added);
  quality.spearman_entropy =
      spearman(score, column(quality.outcomes, &CandidateOutcome::entropy_removed));
  // Ties go to the lower index, as in the loop; NaN is never the favourite. A score that is the
  // same for all has none.
  std::size_t favourite = 0;
  for (std::size_t i = 1; i < score.size(); ++i) {
    if (score[i] > score[favourite] || std::isnan(score[favourite])) favourite = i;
  }
  const double most = added.empty() ? 0 : *std::max_element(added.begin(), added.end());
  const bool has_favourite = std::any_of(score.begin(), score.end(), [&](double value) {
    return std::isfinite(value) && value != score[favourite];
  });
  quality.top1_share = has_favourite && most > 0 ? added[favourite] / most : std::nan("");
  return quality;
}

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
