// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/study_run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
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
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/planner_mesh/oracle_choice.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

// What a candidate truly brings.
struct CandidateOutcome {
  Candidate candidate;
  double new_samples;      // of the mesh, that the map's points cover afterwards and not before
  double new_area;         // what these stand for [m²]
  double entropy_removed;  // by the view, in the map's criterion
};

// How well a policy's scores of candidates tell what they bring.
struct PredictionQuality {
  std::size_t policy = 0;       // index in the spec
  CandidateScores scores;       // a score and an expected area a candidate
  double spearman_area = 0;     // of the score with the truly new samples
  double spearman_entropy = 0;  // of the score with the entropy removed
  double top1_share = 0;        // new samples of the favourite / of the best candidate; NaN
                                // where no score is above another
};

// What is said of the candidates for a view, and what they bring.
struct Prediction {
  std::size_t view = 0;  // after so many views
  std::vector<CandidateOutcome> outcomes;
  std::vector<PredictionQuality> by_policy;  // of those that score views
};

// What ranks by each policy, by its index in the spec.
using Scorers = std::map<std::size_t, PolicyDecision>;

// `count` of a list, evenly spread over it; all if there are no more.
std::vector<Candidate> evenly(const std::vector<Candidate>& from, std::size_t count) {
  if (from.size() <= count) return from;
  std::vector<Candidate> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(from[i * from.size() / count]);
  return some;
}

std::vector<Candidate> candidates_of(RunParts& run, const ViewRecord& record, std::size_t count) {
  // After the last view of the budget nobody has asked for a proposal.
  const std::vector<Candidate> proposed =
      record.proposal.candidates.empty() ? run.generation.generate(record.T_world_camera).candidates
                                         : record.proposal.candidates;
  std::vector<Candidate> candidates = evenly(proposed, count / 2);
  const RunSetup& setup = run.setup;
  const FeasibilityChecker checker(run.model.scene(), run.generation.config().feasibility);
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

// Ties go to the lower index, as in the loop; NaN is never the favourite. A score that is the same
// for all has none.
double top1_share(const std::vector<double>& score, const std::vector<double>& added) {
  std::size_t favourite = 0;
  for (std::size_t i = 1; i < score.size(); ++i) {
    if (score[i] > score[favourite] || std::isnan(score[favourite])) favourite = i;
  }
  const double most = *std::max_element(added.begin(), added.end());
  const bool has_favourite = std::any_of(score.begin(), score.end(), [&](double value) {
    return std::isfinite(value) && value != score[favourite];
  });
  return has_favourite && most > 0 ? added[favourite] / most : std::nan("");
}

// Simulates candidates for the next view without noise, one frame each into a copy of the map, and
// holds what comes of it against the scores: half of `count` from the run's proposal, evenly taken
// from its list, the rest feasible poses of the sphere round the object at the start's distance.
// To be called by the loop's observer. Empty where no policy scores anything, or if a stop was
// requested. Takes some 0.1 s a candidate.
Prediction predict(RunParts& run, const ViewRecord& record, Scorers& scorers, std::size_t count,
                   const ExecConfig& exec, const std::stop_token& stop) {
  Prediction prediction;
  prediction.view = record.index + 1;
  const std::vector<Candidate> candidates = candidates_of(run, record, count);
  if (candidates.empty()) return prediction;
  std::vector<PredictionQuality> by_policy;
  for (auto& [policy, scorer] : scorers) {
    if (auto scores = scorer.scores(candidates)) by_policy.push_back({policy, std::move(*scores)});
  }
  if (by_policy.empty()) return prediction;
  const RunSetup& setup = run.setup;
  const OracleChoice oracle(run.model, setup.sensor,
                            {setup.stage.scene, run.truth, setup.simulation}, exec);
  const auto covered = static_cast<double>(oracle.covered());
  std::vector<CandidateOutcome> outcomes;
  for (const Candidate& candidate : candidates) {
    if (stop.stop_requested()) return prediction;
    const TrueOutcome outcome = oracle.outcome_of(candidate.T_world_camera);
    const double new_samples = static_cast<double>(outcome.covered) - covered;
    outcomes.push_back({candidate, new_samples, new_samples * run.truth->area_per_sample(),
                        outcome.entropy_removed - record.progress.entropy_removed});
  }
  const std::vector<double> added = column(outcomes, &CandidateOutcome::new_samples),
                            removed = column(outcomes, &CandidateOutcome::entropy_removed);
  for (PredictionQuality& quality : by_policy) {
    quality.spearman_area = spearman(quality.scores.score, added);
    quality.spearman_entropy = spearman(quality.scores.score, removed);
    quality.top1_share = top1_share(quality.scores.score, added);
  }
  prediction.outcomes = std::move(outcomes);
  prediction.by_policy = std::move(by_policy);
  return prediction;
}

// As the command line of `reconstruct` has them.
ReconstructOptions options_of(const StudySpec& spec, const StudyRun& run) {
  App app("", "reconstruct");
  ReconstructOptions options;
  add_options(app, options);
  (void)parse(app, reconstruct_words(spec, run));
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
Scorers scorers_of(const StudySpec& spec, const StudyRun& study_run, RunParts& run,
                   const ExecConfig& exec) {
  Scorers scorers;
  for (const std::size_t policy : scored_policies(spec, study_run)) {
    StudyRun other = study_run;
    other.policy = policy;
    PolicyConfig config = policy_config(options_of(spec, other));
    config.object = {run.setup.stage.scene, run.truth, run.setup.simulation};
    scorers.try_emplace(policy, run.model, run.generation, run.setup.sensor, config, exec);
  }
  return scorers;
}

std::optional<StudyResult> result_of(const StudySpec& spec, const StudyRun& study_run, int threads,
                                     const std::stop_token& stop) {
  const ReconstructOptions options = options_of(spec, study_run);
  const ExecConfig exec{threads, parse_tracer(options.common.trace)};
  RunSetup setup = set_up(options, exec);
  setup.planning.stop = stop;
  RunParts run(std::move(setup), options.frames_per_view, exec);
  RunReport report(run.setup.policy, spec.tolerance);
  StudyResult result;
  result.run = {{"prediction", Json::array()}};
  Scorers scorers = scorers_of(spec, study_run, run, exec);
  const std::vector<std::size_t>& views = spec.prediction.views;
  StageSeconds seconds;
  const auto watch_view = [&](const ViewRecord& record) {
    for (const auto& [stage, value] : record.seconds) seconds[stage] += value;
    report.add_view(record, run.model.quality().back(), seconds);
    for (const Candidate& candidate : evenly(record.proposal.candidates, spec.kept_candidates)) {
      result.candidates.push_back(candidate.T_world_camera);
      result.candidate_views.push_back(static_cast<double>(record.index + 1));
    }
    const bool is_asked = std::find(views.begin(), views.end(), record.index + 1) != views.end();
    if (scorers.empty() || !is_asked || stop.stop_requested()) return;
    const Stopwatch watch;
    add_to(result, spec, predict(run, record, scorers, spec.prediction.candidates, exec, stop));
    seconds["prediction"] += watch.seconds();
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

std::optional<StudyResult> make_run(const StudySpec& spec, const StudyRun& run, int threads,
                                    const std::stop_token& stop) {
  return named(spec, run, [&] { return result_of(spec, run, threads, stop); });
}

}  // namespace viewgain::app
