// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "program/commands/study/statistics.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/planner_mesh/oracle_choice.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::app {
namespace {

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

}  // namespace

Prediction predict(Run& run, const ViewRecord& record, Scorers& scorers, std::size_t count,
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
  const RunSetup& setup = run.setup();
  const OracleChoice oracle(run.model(), setup.sensor,
                            {setup.stage.scene, run.truth(), setup.simulation}, exec);
  const auto covered = static_cast<double>(oracle.covered());
  std::vector<CandidateOutcome> outcomes;
  for (const Candidate& candidate : candidates) {
    if (stop.stop_requested()) return prediction;
    const TrueOutcome outcome = oracle.outcome_of(candidate.T_world_camera);
    const double new_samples = static_cast<double>(outcome.covered) - covered;
    outcomes.push_back({candidate, new_samples, new_samples * run.truth()->area_per_sample(),
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

}  // namespace viewgain::app
